// SPDX-License-Identifier: GPL-3.0-or-later
// How fast meshes are checked, repaired, simplified and measured, as JSON; self-intersections and
// repair beside CGAL's own, the proven distance of simplified meshes beside one measured at
// samples. A rough closed body of a million triangles, sound and broken.
//   bench_mesh [--quick] [--simplify] [output.json]
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Surface_mesh.h>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "surf/mesh/check_mesh.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/measure_mesh.h"
#include "surf/mesh/mesh_deviation.h"
#include "surf/mesh/mesh_height_field.h"
#include "surf/mesh/repair_mesh.h"
#include "surf/mesh/self_intersections.h"
#include "surf/mesh/shapes.h"
#include "surf/mesh/simplify_mesh.h"
#include "surf/mesh/smooth_mesh.h"

namespace {

using namespace surf;
using nlohmann::json;
namespace pmp = CGAL::Polygon_mesh_processing;
using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;

template <class Work>
double seconds(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Every triangle with its own corners, some turned, some missing, some twice.
TriangleMesh broken(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (t % 10007 == 5) continue;
    Triangle corners = mesh.triangles[t];
    if (t % 97 == 3) std::swap(corners[0], corners[1]);
    for (int copy = 0; copy < (t % 5003 == 1 ? 2 : 1); ++copy) {
      const auto first = static_cast<std::uint32_t>(soup.vertices_nm.size());
      for (const std::uint32_t v : corners) soup.vertices_nm.push_back(mesh.vertices_nm[v]);
      soup.triangles.push_back({first, first + 1, first + 2});
    }
  }
  return soup;
}

struct Soup {
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> polygons;
};

Soup to_soup(const TriangleMesh& mesh) {
  Soup soup;
  for (const Vec3& v : mesh.vertices_nm) soup.points.emplace_back(v.x, v.y, v.z);
  for (const Triangle& t : mesh.triangles) soup.polygons.push_back({t[0], t[1], t[2]});
  return soup;
}

/// The proven bound, and beside it the largest distance of samples 0.5 nm apart, which must not be
/// above it.
json simplified(const TriangleMesh& mesh, double tolerance_nm) {
  SimplifiedMesh simple;
  const double took =
      seconds([&] { simple = simplify_mesh(mesh, {.tolerance_nm = tolerance_nm}); });
  MeshDeviation sampled;
  const double sampling =
      seconds([&] { sampled = mesh_deviation(mesh, simple.mesh, {.spacing_nm = 0.5}); });
  const SimplifySummary& s = simple.summary;
  return {{"tolerance_nm", tolerance_nm},
          {"seconds", took},
          {"triangles_before", s.triangles_before},
          {"triangles", s.triangles_after},
          {"attempts", s.attempts},
          {"restored", s.restored},
          {"proven_nm", s.deviation.largest_nm()},
          {"sampled_nm", sampled.largest_nm()},
          {"sampling_seconds", sampling},
          {"self_intersections", find_self_intersections(simple.mesh).pairs.size()}};
}

void write(const json& out, const std::string& path) {
  const std::string text = out.dump(2);
  if (path.empty()) fmt::print("{}\n", text);
  else std::ofstream(path) << text << "\n";
}

}  // namespace

int main(int argc, char** argv) {
  bool quick = false, only_simplify = false;
  std::string path;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--quick") == 0) quick = true;
    else if (std::strcmp(argv[i], "--simplify") == 0) only_simplify = true;
    else path = argv[i];
  }
  const double width = quick ? 220 : 705;
  const TriangleMesh mesh = height_field_solid(make_rough({width, width, 1}, 4, 10, 1), -50);
  json out;
  out["triangles"] = mesh.triangles.size();
  for (const double tolerance : {0.1, 1.0}) out["simplify"].push_back(simplified(mesh, tolerance));
  if (only_simplify) {
    write(out, path);
    return 0;
  }
  const TriangleMesh soup = broken(mesh);
  json& s = out["seconds"];
  s["check"] = seconds([&] { check_mesh(mesh); });
  s["check_broken"] = seconds([&] { check_mesh(soup); });
  s["self_intersections"] = seconds([&] { find_self_intersections(mesh); });
  s["self_intersections_1_thread"] =
      seconds([&] { find_self_intersections(mesh, {.threads = 1}); });
  RepairSummary repair;
  s["repair_sound"] = seconds([&] { repair = repair_mesh(mesh).summary; });
  out["sound_unchanged"] = !repair.changed;
  s["repair_broken"] = seconds([&] { repair = repair_mesh(soup).summary; });
  out["repaired"] = {{"sound", repair.sound()},
                     {"merged", repair.merged_vertices},
                     {"turned", repair.turned_triangles},
                     {"filled", repair.filled_holes},
                     {"duplicates", repair.removed_duplicates}};
  s["repair_broken_without_self_intersections"] =
      seconds([&] { repair = repair_mesh(soup, {.resolve_self_intersections = false}).summary; });
  s["smooth_10"] = seconds([&] { smooth_mesh(mesh, {}); });
  s["measure"] = seconds([&] { measure_mesh(mesh); });
  s["height_field"] = seconds([&] { mesh_height_field(mesh, {.pitch_nm = 0.5}); });

  Soup c = to_soup(mesh);
  CGAL::Surface_mesh<Point> cgal;
  s["cgal_from_sound_soup"] =
      seconds([&] { pmp::polygon_soup_to_polygon_mesh(c.points, c.polygons, cgal); });
  std::vector<std::pair<CGAL::SM_Face_index, CGAL::SM_Face_index>> pairs;
  s["cgal_self_intersections"] =
      seconds([&] { pmp::self_intersections(cgal, std::back_inserter(pairs)); });
  c = to_soup(soup);
  CGAL::Surface_mesh<Point> mended;
  s["cgal_repair_soup_orient_stitch"] = seconds([&] {
    pmp::repair_polygon_soup(c.points, c.polygons);
    pmp::orient_polygon_soup(c.points, c.polygons);
    pmp::polygon_soup_to_polygon_mesh(c.points, c.polygons, mended);
    pmp::stitch_borders(mended);
  });
  write(out, path);
}
