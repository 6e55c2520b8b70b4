// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "surf/io/sim/scene_file.h"

namespace surf::cli {

/// Everything `simulate` is told about specimen, beam and scan, as text; absent: not given.
struct SceneOptions {
  std::vector<std::string> inputs;
  std::vector<std::string> materials;   ///< files of the user's own
  bool override_unit = false;
  std::optional<std::string> material, unit, substrate, substrate_z, edge, pitch, z_unit, height_channel;
  std::optional<std::string> energy, tilt, azimuth, spot, convergence, focus, working_distance;
  std::optional<std::string> current, dwell;
  std::optional<std::string> size, pixel_size, region;
  std::optional<std::string> physics, cutoff;
  std::vector<std::string> detectors;
};

/// A scene file with the command line's overrides, or a scene made of meshes and one height field.
/// Assumptions that the user may want to know are added to `notes`. Meshes are read by `read`.
io::SceneFile make_scene(const SceneOptions& options, std::vector<std::string>& notes,
                         const io::BodyReader& read);

}  // namespace surf::cli
