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
  std::string name;      ///< of the glTF node or OBJ object, else the file name without extension
  std::string material;  ///< as the file calls it; empty if the file names none
  TriangleMesh mesh;
  bool unit_assumed = false;  ///< no unit was stated: one file unit was taken for 1 nm
};

/// Reads STL (text and binary), OBJ, PLY (text and binary), OFF, glTF 2.0 (.gltf and .glb), 3MF,
/// VTP or VTM (ParaView). The format is recognised by content, then by name. Polygons are split
/// into fans of triangles. Equal vertices of a body are merged.
///
/// `unit` is the length of one file unit. By default it is the unit that semsurf noted in its own
/// file, which undoes its magnification; else the unit stated by a 3MF file, 1 m for glTF as its
/// specification demands, and 1 nm for the other formats, which state none. A given unit must equal
/// the file's unit, unless it overrides the file. A noted z exaggeration is always undone.
///
/// - OBJ: one body per material in use. The body has the object's name if all its faces lie in one
///   object. In files of semsurf one body per object, without a material.
/// - glTF: one body per node and material of the default scene, with its transforms applied. A mesh
///   shown by several nodes is repeated. The y axis, which is up in glTF, becomes z: (x, y, z) ->
///   (x, -z, y). Buffers are in the file, in data URIs or in files beside it. Points and lines are
///   skipped, images are not loaded.
/// - VTP: polygons and strips. One body per text in an array "material" of the cells or points; in
///   files of semsurf one body per surface.
/// - 3MF: one body per mesh of each item to be built, with its transforms applied.
/// - VTM: the bodies of all its VTP files, which lie in or below its folder.
/// - Other formats: one body, without a material.
///
/// Throws FileError naming the file, the place and the remedy, UsageError for a unit that differs
/// from the file's, Unsupported for compressed, skinned or morphed glTF. Never returns NaN
/// vertices, indices out of range or a body without triangles. Does not check whether bodies are
/// closed.
std::vector<NamedMesh> read_meshes(const std::filesystem::path& path, const MeshUnit& unit = {});

/// Joins all bodies into one mesh and merges equal vertices.
TriangleMesh join(const std::vector<NamedMesh>& meshes);

/// Reads the bodies of the file and joins them.
TriangleMesh read_mesh(const std::filesystem::path& path, const MeshUnit& unit = {});

/// The files that `read_mesh` opens for this one: the file itself, and the buffers beside a glTF
/// file or the blocks of a VTM file. Throws what reading would throw for a file whose JSON or XML
/// is broken.
std::vector<std::filesystem::path> mesh_input_files(const std::filesystem::path& path);

/// Writes one mesh in the format of the extension, as `write_surfaces` does, and returns the names
/// of the files, the main one first. One file unit is `unit_nm` (> 0). The unit is noted in the
/// file (in formats with `SurfaceFormat::magnified` as the magnification 1e6 / unit_nm), so that
/// reading gives nm again. Vertices and triangles keep their order. The file appears under its name
/// only when it is complete. OBJ, PLY, OFF, VTP and VTM keep every digit: with a unit of 1 nm,
/// reading gives the same doubles. STL has 24 bits per coordinate (0.06 nm at 1 mm), so distinct
/// vertices may become equal. Throws InvalidInput for a mesh that `validate` refuses or whose
/// coordinates the format cannot hold, UsageError for an unknown extension or unit, FileError,
/// Unsupported for VTP and VTM without VTK.
std::vector<std::filesystem::path> write_mesh(const std::filesystem::path& path,
                                              const TriangleMesh& mesh, double unit_nm = 1.0);

/// Throws what `write_mesh` would throw for the name or folder, before any work is spent.
void check_mesh_target(const std::filesystem::path& path);

/// Whether the name ends in the extension of a mesh format that can be read (".stl", ".obj",
/// ".ply", ".off", ".glb", ".gltf", ".3mf", ".vtp", ".vtm").
bool is_mesh_file(const std::filesystem::path& path);

/// Whether the file holds a mesh, judged by its content, whatever its name; false if there is no
/// such file. OBJ has no mark, so it is recognised by its name alone.
bool has_mesh_content(const std::filesystem::path& path);

}  // namespace surf::io
