// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "gltf_document.h"
#include "gltf_nodes.h"
#include "gltf_primitive.h"
#include "mesh_formats.h"

namespace surf::io {

GltfMeshes parse_gltf(const std::filesystem::path& path, std::string_view content) {
  GltfDocument document(path, content);
  const std::vector<GltfInstance> instances = gltf_instances(document.root);
  check_gltf_size(document, instances);
  GltfMeshes found{{}, document.unit_nm};
  for (const GltfBody& body : gltf_bodies(document, instances)) {
    NamedMesh mesh{body.name, body.material, {}};
    for (const JsonValue& primitive : body.primitives) {
      append_triangles(document, primitive, body.instance->to_scene, mesh.mesh);
    }
    found.meshes.push_back(std::move(mesh));
  }
  return found;
}

}  // namespace surf::io
