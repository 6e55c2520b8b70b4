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

/// How much a file's body is enlarged. It applies to formats that state metres (glTF), their own
/// unit (3MF) or no unit (STL and OBJ, whose readers take a number for a millimetre): true
/// nanometres vanish in viewers and fall below the tolerances of CAD kernels. The other formats
/// (VTP, VTM, PLY, OFF) hold nm.
struct Magnification {
  double factor = 1e6;        ///< > 0. 1e6: 1 nm becomes 1 mm; 1: true size
  double z_exaggeration = 1;  ///< > 0: additional factor of the heights, in the above formats only
};

/// The data that a format can hold besides triangles.
struct SurfaceFormat {
  std::string_view extension;  ///< ".glb"
  bool several = false;        ///< several surfaces with their names; false: they become one
  bool scalars = false;
  bool drape = false;
  bool tracks = false;
  bool magnified = false;  ///< `Magnification` applies; false: the file holds nm
};

/// The formats that can be written: .glb, .gltf, .3mf, .stl, .obj, .ply, .off, .vtp, .vtm.
const std::vector<SurfaceFormat>& surface_formats();

/// Returns the format of that file name. Throws what `write_surfaces` would throw for the name or
/// folder, before any work is spent.
const SurfaceFormat& check_surface_target(const std::filesystem::path& path);

/// Makes a picture to lay on a surface from a channel of an image: stretched to 256 greys between
/// its 0.5 and 99.5 percentiles. Pixels that are not finite or not valid become black. The image
/// must have the channel.
Drape make_drape(const Image& image, const std::string& channel);

/// Writes in the format of the extension. Data that the format cannot hold are left out;
/// `check_surface_target` says which. Every file states its unit, magnification, exaggeration and
/// metadata; STL has a header of 80 bytes for them, as far as they fit. Vertices and triangles keep
/// their order. Files appear under their names only when they are complete. Files beside the main
/// one (.mtl, .png, .bin, parts of .vtm) appear first.
///
/// - glTF: y is up; float32 nm about the centre of each surface; the centre is on the surface's
///   node, the factor on the root node.
/// - VTP, VTM, OBJ, OFF: double. PLY: double with float scalars. STL, 3MF: float32.
///
/// Formats without `several` join the surfaces in order and hold the scalars that all surfaces
/// have. Returns the names of the files, the main one first. Throws InvalidInput for a scene that
/// `validate` refuses or that the format cannot hold, UsageError for an unknown extension, a bad
/// magnification or a file beside that would replace a stranger (`refuse_strangers`), FileError,
/// Unsupported without VTK.
std::vector<std::filesystem::path> write_surfaces(const std::filesystem::path& path,
                                                  const SurfaceScene& scene,
                                                  const Magnification& magnification = {});

/// Reads the files of `read_meshes`, with scalars, drapes, tracks and metadata if the format holds
/// them. Results are in nm: semsurf's own magnification and exaggeration are undone. Each body
/// becomes one surface, and names are made unique. Vertices keep the file's order and are not
/// merged, so that scalars still fit. `unit` is as in `read_meshes`. Scalars of other programs get
/// names of the form of `VertexScalar` ("Elevation (nm)": elevation_nm). Scalars with a value that
/// is not finite are left out. Throws what `read_meshes` throws, and FileError for a missing
/// picture.
SurfaceScene read_surfaces(const std::filesystem::path& path, const MeshUnit& unit = {});

}  // namespace surf::io
