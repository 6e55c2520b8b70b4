// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace surf::io {

/// A key of a table in a scene file, for the reader and for the reference page.
struct SceneKey {
  std::string name;
  std::string form;  ///< "LENGTH", "mirror|flat|periodic"
  std::string help;
  std::string otherwise;  ///< the default; "required" if the key must be given
};

/// One way to write a table.
struct SceneTable {
  std::string heading;  ///< "height_field"
  std::string shape;    ///< value of the key `shape`: "mesa"; for tables that name a file: "file"
  std::string help;     ///< what the table describes, in a sentence
  std::vector<SceneKey> keys;
  std::string example;  ///< TOML with this table alone
};

/// All tables except [beam], [scan] and [simulation], which hold the parameters of
/// `mc::SimulationRequest`.
const std::vector<SceneTable>& scene_tables();

/// The names of the keys of one table.
std::vector<std::string> keys_of(std::string_view heading, std::string_view shape = {});

/// The keys at the top of a scene file.
const std::vector<SceneKey>& top_scene_keys();

}  // namespace surf::io
