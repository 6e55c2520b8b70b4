// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/height_field.h"
#include "surf/core/progress.h"
#include "surf/mc/physics/material.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf::mc {

/// A triangle mesh filled with one material: closed, or an open sheet (`extend_open_sheet`), which
/// is the top of a half-space and goes on flat beyond its rim.
struct Body {
  std::string name;   ///< for messages: usually the file's name
  TriangleMesh mesh;  ///< normals outward (`validate` accepts all-inward and says so)
  int material = 0;   ///< index into Specimen::materials
};

/// Everything below the plane z = `top_nm`.
struct Substrate {
  int material = 0;
  double top_nm = 0;
};

/// Everything below a height field, which goes on beyond its samples by `edge`.
struct HeightFieldBody {
  std::string name;
  HeightField field;
  int material = 0;
  Edge edge = Edge::mirror;
};

/// What the beam looks at. Where bodies overlap, the later one wins; a height field and a substrate
/// come before all bodies. Faces that coincide within 1e-3 nm are one interface.
struct Specimen {
  std::vector<Material> materials;
  std::optional<Substrate> substrate;
  std::optional<HeightFieldBody> height_field;
  std::vector<Body> bodies;
};

/// Whether a body is an open sheet.
bool is_sheet(const Body& body, const Watch& watch = {});

/// What checking a body has found.
struct BodyFacts {
  std::size_t triangles = 0;
  Box box;
  bool is_sheet = false;  ///< see `is_sheet`
  bool inward = false;    ///< a closed mesh whose normals point inward
};

/// Checks materials, indices, meshes (closed, or sheets; consistently oriented) and the field.
/// Throws InvalidInput with the place of the first fault. At least one solid is needed. The answer
/// is of every body: finding it again would take as long.
std::vector<BodyFacts> validate(const Specimen& specimen, const Watch& watch = {});

/// The box around bodies and height field; for a bare substrate 1000 nm around its origin.
/// z runs from the lowest to the highest surface.
Box extent(const Specimen& specimen);

}  // namespace surf::mc
