// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/shapes.h"
#include "surf/mesh/simplify_mesh.h"

int main() {
  const surf::TriangleMesh sphere = surf::make_sphere({0, 0, 0}, 10);
  if (sphere.vertices_nm.empty()) surf::simplify_mesh(sphere, {});
  return surf::check_mesh(sphere).closed_and_oriented ? 0 : 1;
}
