// SPDX-License-Identifier: GPL-3.0-or-later
// What keeps rays away, as JSON: for a cube's top, the thesis's mesa, a rough surface and a sphere
// on a substrate, at 1 keV and one thread: lookups of the distance bound per second, how far bounds
// fall short of the distance within 3 nm of the surface, and rays per primary. Then what distance
// bounds of waves over a micron take to build, against the number of triangles.
//   bench_near_field [output.json]
#include <chrono>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "geometry/distance_grid.h"
#include "geometry/nearest_triangle.h"
#include "surf/core/random.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/simulate.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/shapes.h"

namespace {

using namespace surf;
using nlohmann::json;

struct Case {
  const char* name;
  mc::Specimen specimen;
  TriangleMesh surface;  // of the specimen, within the view
  double view_nm;
};

mc::Specimen silicon() {
  mc::Specimen s;
  s.materials = {io::find_material("Si", "bench"), io::find_material("Au", "bench")};
  return s;
}

Case field(const char* name, const HeightField& f, Edge edge, double view_nm) {
  mc::Specimen s = silicon();
  s.height_field = mc::HeightFieldBody{name, f, 0, edge};
  return {name, s, height_field_sheet(f), view_nm};
}

Case body(const char* name, const TriangleMesh& mesh, bool on_substrate, double view_nm) {
  mc::Specimen s = silicon();
  s.bodies.push_back({name, mesh, 0});
  if (on_substrate) s.substrate = mc::Substrate{};
  return {name, s, mesh, view_nm};
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

Vec3 isotropic(RandomStream& random) {
  const double c = 1 - 2 * random.uniform(), f = 6.283185307179586 * random.uniform();
  const double s = std::sqrt(1 - c * c);
  return {s * std::cos(f), s * std::sin(f), c};
}

// Short walks, as electrons take them, from points near the surface in the middle of the view.
std::vector<Vec3> walks(const Case& c, RandomStream& random) {
  std::vector<Vec3> points;
  while (points.size() < 100000) {
    const Triangle& t = c.surface.triangles[static_cast<std::size_t>(
        random.uniform() * static_cast<double>(c.surface.triangles.size()))];
    Vec3 p = c.surface.vertices_nm[t[0]];
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    p += (c.surface.vertices_nm[t[1]] - p) * u + (c.surface.vertices_nm[t[2]] - p) * v;
    if (std::max(std::fabs(p.x), std::fabs(p.y)) > 0.4 * c.view_nm) continue;
    for (int i = 0; i < 20; ++i) points.push_back(p += isotropic(random) * 0.7);
  }
  return points;
}

json measure(const Case& c) {
  mc::Scan scan;
  scan.width = scan.height = 64;
  scan.pixel_x_nm = scan.pixel_y_nm = c.view_nm / 64;
  const mc::Scene scene(c.specimen, {}, scan);

  RandomStream random(1, 0, 0);
  const std::vector<Vec3> points = walks(c, random);
  constexpr int times = 20;
  double sum = 0;
  auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < times; ++i)
    for (const Vec3& p : points) sum += scene.distance_bound_nm(p);
  const double lookups = times * static_cast<double>(points.size());
  const double lookup_seconds = seconds_since(begin);

  const TriangleTree tree(c.surface, {}, 0);
  double lost = 0;
  int near = 0;
  for (const Vec3& p : points) {
    mc::NearestTriangle nearest;
    mc::improve(tree, p, nearest);
    double distance = nearest.distance;
    if (c.specimen.substrate) distance = std::min(distance, std::fabs(p.z));
    if (distance > 3) continue;
    ++near;
    lost += distance - scene.distance_bound_nm(p);
  }

  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{5};
  options.threads = 1;
  const mc::SimulationResult result = mc::simulate(scene, options);
  const mc::Balance& b = result.balance;
  const double n = static_cast<double>(b.incident);
  return {{"case", c.name},
          {"triangles", scene.summary().triangles},
          {"cell_nm", scene.summary().grid_cell_nm},
          {"memory_bytes", scene.summary().memory_bytes},
          {"build_seconds", scene.summary().build_seconds},
          {"lookups_per_second", lookups / lookup_seconds},
          {"nanoseconds_per_lookup", 1e9 * lookup_seconds / lookups},
          {"mean_bound_nm", sum / lookups},
          {"mean_shortfall_nm", lost / near},
          {"rays_per_primary", static_cast<double>(b.rays) / n},
          {"steps_per_primary", static_cast<double>(b.steps) / n},
          {"se_yield", static_cast<double>(b.se) / n},
          {"bse_yield", static_cast<double>(b.bse) / n},
          {"primaries_per_second", n / result.seconds}};
}

json build(int samples) {
  HeightField f;
  const double pitch = 1000.0 / samples;
  f.z_nm = Grid<double>(samples, samples, 0.0);
  f.pitch_x_nm = f.pitch_y_nm = pitch;
  for (int y = 0; y < samples; ++y)
    for (int x = 0; x < samples; ++x)
      f.z_nm(x, y) = 10 * std::sin(x * pitch / 14) * std::cos(y * pitch / 11);
  const TriangleMesh mesh = half_space_top(f, 1000);
  const Box domain = bounds(height_field_sheet(f));
  const auto begin = std::chrono::steady_clock::now();
  const std::clock_t used = std::clock();
  const mc::DistanceGrid field(mesh, domain, std::size_t{32} << 20);
  const double seconds = seconds_since(begin);
  return {{"case", "build, waves over a micron"},
          {"triangles", mesh.triangles.size()},
          {"cell_nm", field.cell_nm()},
          {"memory_bytes", field.bytes()},
          {"seconds", seconds},
          {"processor_seconds", static_cast<double>(std::clock() - used) / CLOCKS_PER_SEC}};
}

}  // namespace

int main(int argc, char** argv) {
  json out = json::array();
  out.push_back(measure(body("cube top", make_box({-100, -100, -100}, {100, 100, 0}), false, 100)));
  out.push_back(measure(field("mesa", make_mesa({398, 398, 2}, 200, 80, 2), Edge::flat, 192)));
  out.push_back(measure(field("rough", make_rough({254, 254, 2}, 8, 25, 1), Edge::periodic, 200)));
  out.push_back(measure(body("sphere on a substrate", make_sphere({0, 0, 25}, 25, 5), true, 80)));
  for (const int samples : {200, 707, 2000}) out.push_back(build(samples));
  const std::string text = out.dump(2);
  if (argc < 2) fmt::print("{}\n", text);
  else std::ofstream(argv[1]) << text << "\n";
}
