// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "surf/io/sim/materials.h"
#include "surf/io/sim/mesh_bodies.h"
#include "surf/mc/beam.h"
#include "surf/mc/detector.h"
#include "surf/mc/physics.h"
#include "surf/mc/simulate.h"
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
  bool unit_assumed = false;                   ///< of a mesh: neither its file nor the user said the unit
  mc::Beam beam;
  ScanRequest scan;
  mc::Physics physics;
  std::optional<std::int64_t> electrons;       ///< this, or `accuracy`, or neither
  std::optional<mc::Method> method;            ///< absent: semsurf chooses
  std::optional<double> accuracy, accuracy_floor;   ///< see mc::SimulationOptions
  std::optional<double> mesh_tolerance_nm;     ///< what may be simplified; >= 0, 0 or absent: nothing
  std::optional<std::uint64_t> seed;
  std::optional<double> current_pa, dwell_us;  ///< of the probe; both or none make a dose
  std::vector<mc::Detector> detectors;         ///< besides SE and BSE
  MaterialLibrary materials;                   ///< built-in ones, the scene's own, those of files
  /// Mesh files whose own unit does not count, by name, and the nm of the unit that does.
  std::vector<std::pair<std::string, double>> unit_overrides;
  std::vector<std::filesystem::path> inputs;   ///< files read: the scene itself, then the others
  std::vector<std::string> notes;              ///< what the user may want to know
};

/// Reads a scene in TOML. Paths in it are relative to the scene file. Unknown keys are errors, with
/// the nearest known key suggested. Throws FileError with line and column, UsageError for values.
/// Lengths, energies and angles are numbers (nm, eV, degrees) or texts with a unit; several lengths
/// are an array or a text with commas. All keys, with defaults where they have one:
///
///     title = "80 nm mesa"
///     [beam]
///     energy = "1keV"            # tilt = 0, azimuth = 0, spot = 0, convergence = 0, focus = 0;
///                                # working_distance: parallel beams; current and dwell: the dose
///     [scan]                     # see ScanRequest
///     size = "256x256"           # or 256; pixel_size = "1nm" or "1nm x 2nm";
///                                # region = "-96,-96,96,96" or [-96, -96, 96, 96]
///     [simulation]
///     electrons = 200            # per pixel; seed = 1, physics = "elastic=mott", cutoff = "5eV"
///                                # or, instead of electrons: accuracy = "1%" (or 0.01), with
///                                # accuracy_floor = 0.002; method = "auto" | "direct" | "replay"
///                                # mesh_tolerance = 0: detail below this length may be left out
///     detectors = ["SE1", "quadrants", "loss:energy=900eV.."]   # see mc::parse_detectors
///     [substrate]
///     material = "Si"            # z = 0: the height of its top
///     [height_field]
///     material = "Si"
///     edge = "mirror"            # mirror | flat | periodic
///     shape = "mesa"             # height, top_width, wall_run = 0; or
///                                # "trench": trench_depth, bottom_width, wall_run = 0; or
///                                # "line": height, top_width, wall_run = 0; or
///                                # "via": via_depth, bottom_width, wall_run = 0; or
///                                # "step": height, wall_run = 0; or
///                                # "grating": height, period, top_width, wall_run = 0; or
///                                # "rough": rms, correlation, seed = 1; Gaussian, or with
///                                # hurst = 0.8 (0 to 1) self-affine;
///                                # all: width = 400, depth = width, pitch = 2 (see FieldExtent)
///     # or, instead of shape:
///     # file = "scan.gwy"        # an image or AFM scan; channel: the first of heights;
///                                # z_unit = "nm" or a length per grey level, for what does not say;
///                                # pixel_size replaces the file's and centres the field on (0, 0)
///     [[body]]
///     material = "Au"            # name: the file's or the shape's
///     mesh = "cube.stl"          # unit = "nm", for glTF "m"; another unit than the file states only
///                                # with override_unit = true. A file of several bodies gives all:
///                                # materials of the file that have one of semsurf's names are
///                                # taken as such, for others there is
///                                # materials = { "name in the file" = "Au" }, else `material`
///     # or, instead of mesh:
///     # shape = "box"            # lower = [x, y, z], upper, subdivisions = 1; or
///                                # "sphere": radius, center = [0, 0, 0], subdivisions = 4; or
///     #                          # "cone": bottom_radius, height, top_radius = 0,
///     #                          # base = [0, 0, 0], segments = 64
///     # any body is then scaled about the origin, turned about x, y and z (counter-clockwise seen
///     # from the axis's positive end) and moved, in this order: scale = 1, rotate_x = 0,
///     # rotate_y = 0, rotate_z = 0, move = [0, 0, 0]
///     [[material]]               # the scene's own materials: see MaterialLibrary
///
/// `material_files` are read as well; what they say goes before the scene's own materials. `read` reads
/// the mesh files.
SceneFile read_scene(const std::filesystem::path& path,
                     const std::vector<std::filesystem::path>& material_files = {},
                     const BodyReader& read = read_mesh_bodies);

/// The scene and the files that it names, with those that are read with them (`files_read_with`); nothing but the scene is
/// read whole. Throws what `read_scene` would for a file that is no TOML.
std::vector<std::filesystem::path> scene_input_files(const std::filesystem::path& path);

/// Whether the name ends in ".toml".
bool is_scene_file(const std::filesystem::path& path);

}  // namespace surf::io
