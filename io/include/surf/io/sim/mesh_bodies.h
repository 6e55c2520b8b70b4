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

/// A body of a mesh file, made of one of semsurf's materials.
struct MeshBody {
  std::string name;
  std::string file_material;  ///< what the file calls its material; empty where it says nothing
  std::string material;       ///< semsurf's
  bool is_default = false;    ///< whether the default was taken, as the file's name means nothing
  TriangleMesh mesh;
  bool unit_assumed = false;  ///< as of NamedMesh
};

/// What the names of materials in mesh files mean.
struct MaterialNames {
  std::string fallback = "Si";  ///< for bodies without a material or of an unknown one
  std::map<std::string, std::string> meaning;  ///< the file's name to semsurf's; comes first
  std::string subject = "materials";           ///< what messages name: an option or a place
};

/// Reads the bodies of a mesh file (see `read_meshes`) and gives each a material: what `meaning`
/// says of the file's name, else that name itself where `library` has such a material, else the
/// default. Open pieces of one name and material are joined, so that a closed body painted in
/// several colours is one again. Throws what `read_meshes` and `library.find` throw, and UsageError
/// for a name in `meaning` that the file does not use.
std::vector<MeshBody> read_mesh_bodies(const std::filesystem::path& path, const MeshUnit& unit,
                                       const MaterialNames& names,
                                       const MaterialLibrary& library = {});

/// `read_mesh_bodies`, or what does its work.
using BodyReader = std::function<std::vector<MeshBody>(
    const std::filesystem::path& path, const MeshUnit& unit, const MaterialNames& names,
    const MaterialLibrary& library)>;

}  // namespace surf::io
