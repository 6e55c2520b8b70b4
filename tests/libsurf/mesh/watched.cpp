// SPDX-License-Identifier: GPL-3.0-or-later
// What takes long on large meshes tells of its progress, and ends within a second once it is told
// to.
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <vector>

#include "surf/core/error.h"
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/mesh_deviation.h"
#include "surf/mesh/mesh_height_field.h"
#include "surf/mesh/repair_mesh.h"
#include "surf/mesh/self_intersections.h"
#include "surf/mesh/shapes.h"
#include "surf/mesh/sheet_solid.h"
#include "surf/mesh/simplify_mesh.h"
#include "surf/mesh/vertex_curvature.h"

namespace surf {
namespace {

using Clock = std::chrono::steady_clock;

struct Work {
  const char* name;
  std::function<void(const TriangleMesh& mesh, const Watch& watch)> run;
};

/// With a hole that is filled, and with a second body that it passes through.
TriangleMesh broken(TriangleMesh mesh) {
  for (int i = 0; i < 20; ++i) mesh.triangles.pop_back();
  const auto first = static_cast<std::uint32_t>(mesh.vertices_nm.size());
  const Vec3 middle = bounds(mesh).center_nm();
  const TriangleMesh ball = make_sphere(middle, 6, 2);
  mesh.vertices_nm.insert(mesh.vertices_nm.end(), ball.vertices_nm.begin(), ball.vertices_nm.end());
  for (const auto& [a, b, c] : ball.triangles)
    mesh.triangles.push_back({first + a, first + b, first + c});
  return mesh;
}

std::vector<Work> works() {
  return {
      {"check_mesh", [](const TriangleMesh& m, const Watch& w) { check_mesh(m, w); }},
      {"find_self_intersections",
       [](const TriangleMesh& m, const Watch& w) { find_self_intersections(m, {.watch = w}); }},
      {"mean_curvature", [](const TriangleMesh& m, const Watch& w) { mean_curvature(m, 0, w); }},
      {"mesh_deviation",
       [](const TriangleMesh& m, const Watch& w) { mesh_deviation(m, m, {.watch = w}); }},
      {"mesh_height_field",
       [](const TriangleMesh& m, const Watch& w) {
         mesh_height_field(m, {.pitch_nm = 0.5, .watch = w});
       }},
      {"sheet_solid", [](const TriangleMesh& m, const Watch& w) { sheet_solid(m, -1000, w); }},
      {"simplify_mesh, tolerance",
       [](const TriangleMesh& m, const Watch& w) {
         SimplifySummary summary;
         summary = simplify_mesh(m, {.tolerance_nm = 0.3, .watch = w}).summary;
       }},
      {"simplify_mesh, triangles",
       [](const TriangleMesh& m, const Watch& w) {
         SimplifySummary summary;
         summary = simplify_mesh(m, {.triangles = 1000, .watch = w}).summary;
       }},
      {"repair_mesh", [](const TriangleMesh& m, const Watch& w) {
         RepairSummary summary;
         summary = repair_mesh(broken(m), {.watch = w}).summary;
       }}};
}

TriangleMesh sheet(int samples) {
  return height_field_sheet(make_rough({samples - 1.0, samples - 1.0, 1}, 4, 12, 3));
}

TEST(WatchedMeshes, TellARisingProgress) {
  const TriangleMesh mesh = sheet(70);
  for (const Work& work : works()) {
    double last = 0;
    int told = 0;
    work.run(mesh, {[&](double done, double total) {
                      EXPECT_GE(done / total, last) << work.name;
                      EXPECT_LE(done / total, 1) << work.name;
                      last = done / total;
                      ++told;
                    },
                    nullptr});
    EXPECT_GE(told, 1) << work.name;
  }
}

TEST(WatchedMeshes, EndSoonWhenToldTo) {
  const TriangleMesh mesh = sheet(140);
  for (const Work& work : works()) {
    CancelToken before;
    before.cancel();
    EXPECT_THROW(work.run(mesh, {{}, &before}), Interrupted) << work.name;
    // Once it has begun: from the first word of its progress on.
    CancelToken during;
    Clock::time_point told;
    const auto stop = [&](double, double) {
      if (!during.cancelled()) told = Clock::now();
      during.cancel();
    };
    EXPECT_THROW(work.run(mesh, {stop, &during}), Interrupted) << work.name;
    EXPECT_LT(std::chrono::duration<double>(Clock::now() - told).count(), 1) << work.name;
  }
}

}  // namespace
}  // namespace surf
