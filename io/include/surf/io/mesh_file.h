// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "surf/io/mesh_unit.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf::io {

/// One of the bodies in a mesh file.
struct NamedMesh {
  std::string name;      ///< of the glTF node or OBJ object, else the file's without extension
  std::string material;  ///< what the file calls its material; empty where it says nothing
  TriangleMesh mesh;
  bool unit_assumed = false;  ///< nobody said what a 1 of the file is: it was taken for 1 nm
};

/// Reads STL (text and binary), OBJ, PLY (text and binary), OFF, glTF 2.0 (.gltf and .glb), 3MF,
/// VTP or VTM (ParaView), by content and then by name. Polygons are fanned into triangles; equal
/// vertices of a body are merged. `unit` is the length of one file unit. By default it is what
/// semsurf noted in a file that it wrote, so that its magnification is undone, else 1 nm, as the
/// formats carry none, 1 m for glTF, whose specification says so, and what 3MF files say. A unit
/// that is given has to be the same as what the file says, unless it overrides the file; a noted z
/// exaggeration is undone all the same.
/// - OBJ: one body per material in use, with the object's name where all its faces lie in one; in
/// files of
///   semsurf one per object, without a material.
/// - glTF: one body per node and material of the default scene, its transforms applied; a mesh that
///   several nodes show is repeated. Its y axis, which is up, becomes z: (x, y, z) -> (x, -z, y).
///   Buffers are in the file, in data URIs or in files beside it. Points and lines are skipped,
///   images not loaded.
/// - VTP: polygons and strips; one body per text in an array "material" of the cells or points, in
/// files of
///   semsurf one per surface.
/// - 3MF: one body per mesh of each item to be built, its transforms applied.
/// - VTM: the bodies of all its VTP files, which lie in or below its folder.
/// - The others: one body, without a material.
/// Throws FileError naming the file, the place and the remedy, UsageError for a unit that is not
/// the file's, Unsupported for compressed, skinned or morphed glTF; never returns NaN vertices,
/// indices out of range or a body without triangles. Closedness is not checked here.
std::vector<NamedMesh> read_meshes(const std::filesystem::path& path, const MeshUnit& unit = {});

/// All bodies as one mesh, equal vertices merged.
TriangleMesh join(const std::vector<NamedMesh>& meshes);

/// The bodies of the file, joined.
TriangleMesh read_mesh(const std::filesystem::path& path, const MeshUnit& unit = {});

/// The files that `read_mesh` opens for this one: itself, and the buffers beside a glTF file or the
/// blocks of a VTM file. Throws what reading would for a file whose JSON or XML is broken.
std::vector<std::filesystem::path> mesh_input_files(const std::filesystem::path& path);

/// Writes a mesh alone as `write_surfaces` does, by extension, and returns the same, one file unit
/// being `unit_nm` (> 0). The unit is noted in the file (in formats of `SurfaceFormat::magnified`
/// as the magnification 1e6 / unit_nm), so that reading gives nm again. Vertices and triangles keep
/// their order. The file appears under its name only when it is complete. OBJ, PLY, OFF, VTP and
/// VTM keep every digit: with a unit of 1 nm, reading gives the same doubles. STL has 24 bits per
/// coordinate (0.06 nm at 1 mm) and may so make vertices equal that were not. Throws InvalidInput
/// for a mesh that `validate` refuses or whose coordinates the format cannot hold, UsageError for
/// an unknown extension or unit, FileError, Unsupported for VTP and VTM without VTK.
std::vector<std::filesystem::path> write_mesh(const std::filesystem::path& path,
                                              const TriangleMesh& mesh, double unit_nm = 1.0);

/// Throws what `write_mesh` would for the name or folder, before any work is spent.
void check_mesh_target(const std::filesystem::path& path);

/// Whether the name ends in the extension of a mesh format that is read (".stl", ".obj", ".ply",
/// ".off", ".glb", ".gltf", ".3mf", ".vtp", ".vtm").
bool is_mesh_file(const std::filesystem::path& path);

/// Whether the content is that of a mesh, whatever the name; false where there is no such file. OBJ
/// has no mark and is known by its name alone.
bool has_mesh_content(const std::filesystem::path& path);

}  // namespace surf::io
