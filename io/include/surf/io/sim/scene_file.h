// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "surf/mc/beam.h"
#include "surf/mc/physics.h"
#include "surf/mc/specimen.h"

namespace surf::io {

/// What the user asked of the scan. Any two of size, pixel and region define it; see
/// `workflow::resolve_scan`.
struct ScanRequest {
  std::optional<int> width, height;                       ///< pixels
  std::optional<double> pixel_x_nm, pixel_y_nm;
  struct Region { double x0_nm, y0_nm, x1_nm, y1_nm; };   ///< outer pixel edges
  std::optional<Region> region;
};

/// A scene file: what is simulated, and how unless the command line says otherwise.
struct SceneFile {
  std::string title;
  mc::Specimen specimen;
  mc::Beam beam;
  ScanRequest scan;
  mc::Physics physics;
  std::optional<std::int64_t> electrons;
  std::optional<std::uint64_t> seed;
  std::vector<std::filesystem::path> inputs;   ///< files read: the scene itself, then meshes and fields
};

/// Reads a scene in TOML. Paths in it are relative to the scene file. Unknown keys are errors, with
/// the nearest known key suggested. Throws FileError with line and column, UsageError for values.
///
///     title = "80 nm mesa"
///     [beam]
///     energy = "1keV"            # tilt, azimuth, spot
///     [scan]
///     size = "256x256"           # pixel_size = "1nm", region = "-96,-96,96,96"
///     [simulation]
///     electrons = 200            # seed, physics = "elastic=mott"
///     [substrate]
///     material = "Si"            # z = "0nm"
///     [height_field]
///     material = "Si"
///     edge = "mirror"            # mirror | flat | periodic
///     shape = "mesa"             # mesa | trench | rough, with the parameters of make_mesa ...;
///                                # or file = "scan.tif", channel, pixel_size, z_unit
///     [[body]]
///     material = "Au"
///     mesh = "cube.stl"          # with unit, scale, move, rotate_z; or shape = "box" | "sphere"
SceneFile read_scene(const std::filesystem::path& path);

/// Whether the name ends in ".toml".
bool is_scene_file(const std::filesystem::path& path);

}  // namespace surf::io
