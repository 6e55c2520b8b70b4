// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "document.h"
#include "mesh/affine_map.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf::io {

/// A node of a glTF scene that shows a mesh.
struct GltfInstance {
  JsonValue node;
  JsonValue mesh;
  AffineMap to_scene;  ///< from the mesh's frame to the scene's, y up
};

/// Every showing of a mesh in the default scene (else in the first, else in the whole file),
/// parents before children. Throws FileError for a node with two parents or above itself,
/// Unsupported for meshes that a skeleton or shape keys deform.
std::vector<GltfInstance> gltf_instances(const JsonValue& root);

// What the primitives of a glTF scene hold, in units of the scene, z up, exaggeration undone.

bool has_triangles(const JsonValue& primitive);
/// Separate straight lines (LINES), as semsurf writes tracks.
bool has_lines(const JsonValue& primitive);

/// Many nodes can show one mesh: this stops a small file from filling the memory.
void check_gltf_size(const GltfDocument& document, const std::vector<GltfInstance>& instances);

std::vector<Vec3> gltf_points(GltfDocument& document, const JsonValue& primitive,
                              const AffineMap& to_scene);

/// Appends its triangles, turned the right way round where the map mirrors.
void append_triangles(GltfDocument& document, const JsonValue& primitive, const AffineMap& to_scene,
                      TriangleMesh& mesh);

/// What one node shows in one material.
struct GltfBody {
  std::string name;      ///< the node's, else the mesh's, else empty
  std::string material;  ///< the name of it, or empty
  const GltfInstance* instance;
  std::vector<JsonValue> primitives;  ///< with triangles; one or more
};

/// In the order of nodes and, of each, of their first primitive. `instances` must outlive the
/// result.
std::vector<GltfBody> gltf_bodies(const GltfDocument& document,
                                  const std::vector<GltfInstance>& instances);

}  // namespace surf::io
