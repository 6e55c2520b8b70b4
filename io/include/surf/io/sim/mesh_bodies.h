// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "surf/io/mesh_unit.h"
#include "surf/io/sim/materials.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf::io {

/// A body of a mesh file with one of semsurf's materials.
struct MeshBody {
  std::string name;
  std::string file_material;  ///< as the file calls it; empty if the file names none
  std::string material;       ///< name of semsurf's material
  bool is_default = false;    ///< the default was taken: the file's name is unknown or empty
  TriangleMesh mesh;
  bool unit_assumed = false;  ///< as in NamedMesh
};

/// How the names of materials in mesh files are translated.
struct MaterialNames {
  std::string fallback = "Si";  ///< for bodies without a material or with an unknown one
  std::map<std::string, std::string> meaning;  ///< file's name to semsurf's name; takes precedence
  std::string subject = "materials";           ///< the name used in messages: an option or a place
};

/// Reads the bodies of a mesh file (see `read_meshes`) and gives each a material: the one that
/// `meaning` assigns to the file's name, else the material of that name in `library`, else the
/// default. Open pieces of one name and material are joined, so that a closed body painted in
/// several colours becomes one body again. Throws what `read_meshes` and `library.find` throw, and
/// UsageError for a name in `meaning` that the file does not use.
std::vector<MeshBody> read_mesh_bodies(const std::filesystem::path& path, const MeshUnit& unit,
                                       const MaterialNames& names,
                                       const MaterialLibrary& library = {});

/// `read_mesh_bodies` or a function that replaces it.
using BodyReader = std::function<std::vector<MeshBody>(
    const std::filesystem::path& path, const MeshUnit& unit, const MaterialNames& names,
    const MaterialLibrary& library)>;

}  // namespace surf::io
