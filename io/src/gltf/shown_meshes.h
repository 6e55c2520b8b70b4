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

/// Every instance of a mesh in the default scene (else in the first scene, else in the whole file),
/// parents before children. Throws FileError for a node with two parents or in a cycle, Unsupported
/// for meshes deformed by a skeleton or shape keys.
std::vector<GltfInstance> gltf_instances(const JsonValue& root);

// The content of the primitives of a glTF scene, in units of the scene, z up, exaggeration undone.

bool has_triangles(const JsonValue& primitive);
/// Separate straight lines (LINES), as semsurf writes tracks.
bool has_lines(const JsonValue& primitive);

/// Throws if the instances are too large together: many nodes can show one mesh, so a small file
/// could fill the memory.
void check_gltf_size(const GltfDocument& document, const std::vector<GltfInstance>& instances);

std::vector<Vec3> gltf_points(GltfDocument& document, const JsonValue& primitive,
                              const AffineMap& to_scene);

/// Appends the primitive's triangles, with their orientation reversed if the map mirrors.
void append_triangles(GltfDocument& document, const JsonValue& primitive, const AffineMap& to_scene,
                      TriangleMesh& mesh);

/// The part of one node in one material.
struct GltfBody {
  std::string name;      ///< name of the node, else of the mesh, else empty
  std::string material;  ///< name of the material, or empty
  const GltfInstance* instance;
  std::vector<JsonValue> primitives;  ///< one or more, with triangles
};

/// The bodies in the order of nodes, and for each node in the order of the first primitives.
/// `instances` must outlive the result.
std::vector<GltfBody> gltf_bodies(const GltfDocument& document,
                                  const std::vector<GltfInstance>& instances);

}  // namespace surf::io
