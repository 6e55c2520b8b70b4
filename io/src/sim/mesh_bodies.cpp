// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/sim/mesh_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "sim/suggest.h"
#include "surf/core/error.h"
#include "surf/io/mesh_file.h"
#include "surf/io/sim/materials.h"
#include "surf/mesh/check_mesh.h"

namespace surf::io {
namespace {

bool is_material(const std::string& name, const MaterialLibrary& library) {
  const auto& all = library.all();
  return std::any_of(all.begin(), all.end(), [&](const mc::Material& m) { return m.name == name; });
}

void check_meaning(const std::vector<NamedMesh>& meshes, const MaterialNames& names,
                   const MaterialLibrary& library, const std::string& file) {
  std::set<std::string> in_file;
  for (const NamedMesh& mesh : meshes) {
    if (!mesh.material.empty()) in_file.insert(mesh.material);
  }
  for (const auto& [name, material] : names.meaning) {
    library.find(material, names.subject);
    if (in_file.contains(name)) continue;
    throw UsageError(
        names.subject, fmt::format("{} has no material '{}'", file, name),
        in_file.empty() ? "Leave it out: the file names no materials"
                        : fmt::format("Choose one of: {}",
                                      join(nearest_first(name, {in_file.begin(), in_file.end()}))));
  }
}

MeshBody with_material(NamedMesh mesh, const MaterialNames& names, const MaterialLibrary& library) {
  MeshBody body{mesh.name, mesh.material, {}, false, std::move(mesh.mesh), mesh.unit_assumed};
  const auto meaning = names.meaning.find(body.file_material);
  if (meaning != names.meaning.end()) {
    body.material = meaning->second;
  } else if (!body.file_material.empty() && is_material(body.file_material, library)) {
    body.material = body.file_material;
  } else {
    body.material = names.fallback;
    body.is_default = true;
  }
  return body;
}

bool is_open(const MeshBody& body) { return !check_mesh(body.mesh).closed_and_oriented; }

/// Where an open piece of the same name and material is, if the piece is open, too; else
/// bodies.end().
auto find_partner(std::vector<MeshBody>& bodies, const MeshBody& piece) {
  return std::find_if(bodies.begin(), bodies.end(), [&](const MeshBody& body) {
    return body.name == piece.name && body.material == piece.material && is_open(body) &&
           is_open(piece);
  });
}

void add_piece(std::vector<MeshBody>& bodies, MeshBody piece) {
  const auto partner = find_partner(bodies, piece);
  if (partner == bodies.end()) {
    bodies.push_back(std::move(piece));
    return;
  }
  partner->mesh = join({{{}, {}, std::move(partner->mesh)}, {{}, {}, std::move(piece.mesh)}});
  if (partner->file_material != piece.file_material) partner->file_material.clear();
}

}  // namespace

std::vector<MeshBody> read_mesh_bodies(const std::filesystem::path& path, const MeshUnit& unit,
                                       const MaterialNames& names, const MaterialLibrary& library) {
  library.find(names.fallback, names.subject);
  std::vector<NamedMesh> meshes = read_meshes(path, unit);
  check_meaning(meshes, names, library, path.string());
  std::vector<MeshBody> bodies;
  for (NamedMesh& mesh : meshes) add_piece(bodies, with_material(std::move(mesh), names, library));
  return bodies;
}

}  // namespace surf::io
