// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace surf::io {

/// A key of a table of a scene file, for the reader and for the reference.
struct SceneKey {
  std::string name;
  std::string form;  ///< "LENGTH", "mirror|flat|periodic"
  std::string help;
  std::string otherwise;  ///< what holds where it is missing; "required" where it may not be
};

/// One way to write a table.
struct SceneTable {
  std::string heading;  ///< "height_field"
  std::string shape;    ///< of tables with a key `shape`: "mesa"; those that name a file: "file"
  std::string help;     ///< what it is, in a sentence
  std::vector<SceneKey> keys;
  std::string example;  ///< TOML, of this table alone
};

/// All but [beam], [scan] and [simulation], which hold the parameters of `mc::SimulationRequest`.
const std::vector<SceneTable>& scene_tables();

/// Names of the keys of one of them.
std::vector<std::string> keys_of(std::string_view heading, std::string_view shape = {});

/// Keys at the top of a scene file.
const std::vector<SceneKey>& top_scene_keys();

}  // namespace surf::io
