// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "surf/core/image.h"
#include "surf/io/mesh_unit.h"
#include "surf/mesh/surface.h"

namespace surf::io {

/// How much larger than the specimen a file's body is, in formats that carry metres (glTF), their
/// own unit (3MF) or nothing (STL and OBJ, whose readers take a number for a millimetre). True
/// nanometres vanish in viewers and fall below the tolerances of CAD kernels. The other formats
/// (VTP, VTM, PLY, OFF) hold nm.
struct Magnification {
  double factor = 1e6;  ///< > 0. 1e6: 1 nm becomes 1 mm; 1: true size
  double z_exaggeration =
      1;  ///< > 0: heights are this much larger still, in the formats above only
};

/// What a format can hold besides triangles.
struct SurfaceFormat {
  std::string_view extension;  ///< ".glb"
  bool several = false;        ///< several surfaces with their names; else they become one
  bool scalars = false;
  bool drape = false;
  bool tracks = false;
  bool magnified = false;  ///< `Magnification` is for it; else the file holds nm
};

/// What is written: .glb, .gltf, .3mf, .stl, .obj, .ply, .off, .vtp, .vtm.
const std::vector<SurfaceFormat>& surface_formats();

/// The format of that name. Throws what `write_surfaces` would for the name or folder, before any
/// work is spent.
const SurfaceFormat& check_surface_target(const std::filesystem::path& path);

/// A channel of an image as a picture to lay on a surface: stretched to 256 greys between its 0.5
/// and 99.5 percentiles, pixels that are not finite or not valid black. The channel must be there.
Drape make_drape(const Image& image, const std::string& channel);

/// Writes by extension. What the format cannot hold is left out: ask `check_surface_target` what
/// that is. Every file says its unit, magnification, exaggeration and metadata, STL in its header
/// of 80 bytes as far as they fit. Vertices and triangles keep their order. Files appear under
/// their names only when they are complete, those beside the main one (.mtl, .png, .bin, parts of
/// .vtm) first.
/// - glTF: y up; float32 nm about the centre of each surface, the centre on its node, the factor on
/// the root node.
/// - VTP, VTM, OBJ, OFF: double. PLY: double with float scalars. STL, 3MF: float32.
/// Formats without `several` join the surfaces in order and hold the scalars that all have.
/// Returns the names of the files, the main one first. Throws InvalidInput for a scene that
/// `validate` refuses or that the format cannot hold, UsageError for an unknown extension, a bad
/// magnification or a file beside that would replace a stranger (`refuse_strangers`), FileError,
/// Unsupported without VTK.
std::vector<std::filesystem::path> write_surfaces(const std::filesystem::path& path,
                                                  const SurfaceScene& scene,
                                                  const Magnification& magnification = {});

/// Reads what `read_meshes` reads, with scalars, drapes, tracks and metadata where the format holds
/// them, in nm: semsurf's own magnification and exaggeration are undone. One surface per body,
/// names made unique. Vertices keep the file's order and are not merged, so that scalars fit.
/// `unit` as in `read_meshes`. Scalars of other programs get names of the form of `VertexScalar`
/// ("Elevation (nm)": elevation_nm); those with a value that is not finite are left out. Throws
/// what `read_meshes` throws, FileError for a picture that is missing.
SurfaceScene read_surfaces(const std::filesystem::path& path, const MeshUnit& unit = {});

}  // namespace surf::io
