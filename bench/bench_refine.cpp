// SPDX-License-Identifier: GPL-3.0-or-later
// How far meshes with undercuts are off that `semsurf refine` finds from two tilted SEM images, and
// whether their errors hold. The images are by the other tier of physics:
//   bench_refine [FOLDER [CASES [SEED [own]]]]   with a folder (or ""), inputs and results go
//   there; CASES: names with commas between, as line100,cube; own: images by the physics of the fit
// Lines 100 nm high whose walls lean by 75 to 100 degrees, a mushroom, a cube on a pillar; pixels
// of 4 nm, 150 electrons each, a spot of 2 nm; starts that are 5 to 10 nm off. Tilts to both sides.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "surf/core/words.h"
#include "surf/io/cache.h"
#include "surf/io/image_file.h"
#include "surf/io/mesh_file.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/simulate.h"
#include "surf/mesh/triangle_tree.h"
#include "surf/mesh/vertex_normals.h"
#include "surf/profile/feature_shape.h"
#include "surf/workflow/libraries.h"
#include "surf/workflow/refine_job.h"

namespace {

using namespace surf;

constexpr double pixel_nm = 4, spot_nm = 2, energy_ev = 1000, gain = 900, offset = 120;

struct Case {
  std::string name;
  TriangleMesh truth, start;
  double tilt_deg = 15;
  int columns = 64, rows = 40;
  double line_height_nm = 0;  ///< of a line; 0: it is none
  double lean_nm = 0;         ///< of its walls over their feet
};

using Loop = std::vector<Vec3>;

/// A sheet from its outermost loop to its innermost, which is closed by a fan.
TriangleMesh stacked(const std::vector<Loop>& loops) {
  TriangleMesh mesh;
  const auto n = static_cast<std::uint32_t>(loops.front().size());
  for (const Loop& loop : loops)
    mesh.vertices_nm.insert(mesh.vertices_nm.end(), loop.begin(), loop.end());
  for (std::uint32_t k = 0; k + 1 < loops.size(); ++k)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t j = (i + 1) % n, a = k * n, b = a + n;
      mesh.triangles.push_back({a + i, a + j, b + j});
      mesh.triangles.push_back({a + i, b + j, b + i});
    }
  Vec3 middle;
  for (const Vec3& p : loops.back()) middle += p * (1.0 / n);
  mesh.vertices_nm.push_back(middle);
  const auto last = static_cast<std::uint32_t>((loops.size() - 1) * n),
             top = static_cast<std::uint32_t>(mesh.vertices_nm.size() - 1);
  for (std::uint32_t i = 0; i < n; ++i)
    mesh.triangles.push_back({last + i, last + (i + 1) % n, top});
  return mesh;
}

Loop circle(double radius, double z) {
  constexpr int points = 72;
  Loop out;
  for (int i = 0; i < points; ++i) {
    const double a = 2 * std::numbers::pi * i / points;
    out.push_back({radius * std::cos(a), radius * std::sin(a), z});
  }
  return out;
}

Loop square(double half, double z) {
  constexpr int side = 18;
  Loop out;
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < side; ++i) {
      const double t = -half + 2 * half * i / side;
      out.push_back(k == 0   ? Vec3{half, t, z}
                    : k == 1 ? Vec3{-t, half, z}
                    : k == 2 ? Vec3{-half, -t, z}
                             : Vec3{t, -half, z});
    }
  return out;
}

constexpr double beyond_nm = 400;

/// A round cap on a stem.
TriangleMesh mushroom(double stem_radius, double stem_height, double cap_radius,
                      double cap_height) {
  std::vector<Loop> loops{circle(beyond_nm, 0), circle(stem_radius, 0),
                          circle(stem_radius, stem_height)};
  constexpr int steps = 14;
  for (int i = 0; i <= steps; ++i) {  // an ellipse from its lower side to its top
    const double a = std::numbers::pi * (-0.42 + (0.5 + 0.42) * i / steps) * 0.985;
    loops.push_back(
        circle(cap_radius * std::cos(a), stem_height + 0.5 * cap_height * (1 + std::sin(a))));
  }
  return stacked(loops);
}

TriangleMesh cube_on_pillar(double pillar, double under, double cube, double height) {
  return stacked({square(beyond_nm, 0), square(0.5 * pillar, 0), square(0.5 * pillar, under),
                  square(0.5 * cube, under), square(0.5 * cube, under + height)});
}

TriangleMesh line(double width, double angle, double height, double top, double foot) {
  FeatureShape f;
  f.kind = FeatureKind::line;
  f.width_nm = width;
  f.wall = {height, angle, top, foot};
  return feature_mesh(f, 700);
}

Case line_case(double angle, double tilt) {
  return {fmt::format("line{:g}", angle),
          line(92, angle, 100, 4, 3),
          line(98, 90, 104, 3, 3),
          tilt,
          64,
          16,
          100,
          100 * std::tan((angle - 90) * std::numbers::pi / 180)};
}

std::vector<Case> all_cases() {
  return {line_case(100, 15),
          line_case(96, 10),
          line_case(88, 15),
          line_case(75, 15),
          {"mushroom", mushroom(25, 45, 62, 60), mushroom(30, 50, 57, 54), 20, 56, 56},
          {"cube", cube_on_pillar(50, 40, 90, 70), cube_on_pillar(60, 46, 96, 66), 20, 56, 56}};
}

PlacedImage image_of(const Case& c, double azimuth_deg, std::uint64_t seed, bool own,
                     mc::LibrarySource& libraries) {
  mc::Specimen specimen;
  specimen.materials = {io::find_material("Si", "bench")};
  specimen.bodies.push_back({"truth", c.truth, 0});
  mc::Beam beam;
  beam.energy_ev = energy_ev, beam.spot_nm = spot_nm;
  beam.tilt_deg = c.tilt_deg, beam.azimuth_deg = azimuth_deg;
  mc::Scan scan;
  scan.width = c.columns, scan.height = c.rows;
  scan.pixel_x_nm = scan.pixel_y_nm = pixel_nm;
  scan.center_x_nm = 2.5, scan.center_y_nm = -1;
  scan.center_z_nm = 50;
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{150};
  options.method = mc::Method::replay;
  options.seed = seed;
  options.least_cascades = 100'000;
  mc::Physics physics;
  if (!own) mc::parse_physics("inelastic=dielectric", physics);
  const mc::SimulationResult done =
      mc::simulate(mc::Scene(specimen, beam, scan, physics), options, {.libraries = &libraries});
  PlacedImage image;
  image.pitch_x_nm = image.pitch_y_nm = pixel_nm;
  image.origin_x_nm = -0.5 * (c.columns - 1) * pixel_nm;
  image.origin_y_nm = -0.5 * (c.rows - 1) * pixel_nm;
  image.values = Grid<double>(c.columns, c.rows);
  for (int y = 0; y < c.rows; ++y)
    for (int x = 0; x < c.columns; ++x)
      image.values(x, y) = offset + gain * done.yield(0, x, y).mean;
  return image;
}

/// How far a vertex is from a surface, along its own normal.
double off_nm(const Vec3& p, const Vec3& normal, const TriangleTree& truth) {
  const auto nearest = truth.closest(p);
  const Vec3 there = closest_point(truth.corners(nearest.triangle), p);
  const double sign = dot(p - there, normal) < 0 ? -1 : 1;
  return sign * nearest.distance_nm;
}

struct Score {
  double squares = 0, held = 0, count = 0;
  void add(double off, double deviation) {
    squares += off * off, held += std::abs(off) < 2 * deviation, ++count;
  }
  std::string words() const {
    return count == 0 ? "none"
                      : fmt::format("{:.2f} nm rms, {:.0f} % within two, {:g} vertices",
                                    std::sqrt(squares / count), 100 * held / count, count);
  }
};

/// How far a wall leans out over its foot, and the standard error of that.
struct Lean {
  double value = 0, error = 0;
};
Lean lean_of(const TriangleMesh& mesh, const workflow::RefineSummary& s, bool right,
             double height) {
  const std::vector<Vec3> normals = vertex_normals(mesh);
  std::vector<std::size_t> wall;
  double z = 0, x = 0;
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const Vec3& p = mesh.vertices_nm[v];
    if (std::abs(p.y) > 28 || p.z < 0.12 * height || p.z > 0.88 * height ||
        normals[v].x * (right ? 1 : -1) < 0.7)
      continue;
    wall.push_back(v);
    z += p.z, x += p.x;
  }
  const auto n = static_cast<double>(wall.size());
  z /= n, x /= n;
  double zz = 0, xz = 0;
  for (const std::size_t v : wall) {
    const Vec3& p = mesh.vertices_nm[v];
    zz += (p.z - z) * (p.z - z), xz += (p.z - z) * (p.x - x);
  }
  // The slope is a linear function of the vertices' places, to the first order.
  const double slope = xz / zz;
  std::vector<double> weight(mesh.vertices_nm.size(), 0);
  for (const std::size_t v : wall) weight[v] = (mesh.vertices_nm[v].z - z) / zz;
  std::vector<double> by(s.modes.size(), 0);
  for (std::size_t k = 0; k < by.size(); ++k)
    for (const MeshMode::Move& m : s.modes[k].moves)
      by[k] += weight[m.vertex] * (m.by.x - slope * m.by.z);
  double variance = 0;
  for (std::size_t k = 0; k < by.size(); ++k)
    for (std::size_t l = 0; l < by.size(); ++l)
      variance += by[k] * by[l] * s.covariance[k * by.size() + l];
  return {(right ? 1 : -1) * slope * height, std::sqrt(variance) * height};
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void measure(const Case& c, const std::string& folder, std::uint64_t seed, bool own,
             workflow::CachedLibraries& libraries) {
  workflow::RefineJob job;
  job.start = c.start;
  job.material = io::find_material("Si", "bench");
  job.energy_ev = energy_ev, job.spot_nm = spot_nm;
  job.tilts_deg = {c.tilt_deg};
  job.azimuths_deg = {0, 180};
  job.height_error_nm = 4;
  job.electrons = 600, job.effect_electrons = 50, job.smooth_rounds = 4;
  if (c.line_height_nm > 0) job.bump_rounds = 0;  // a line has no other shape
  job.cache = io::cache_folder("");
  for (const double azimuth : job.azimuths_deg) {
    job.images.push_back(
        {image_of(c, azimuth, seed + static_cast<std::uint64_t>(azimuth), own, libraries),
         fmt::format("{}-{:g}.exr", c.name, azimuth)});
  }
  if (!folder.empty()) {
    const std::filesystem::path home = std::filesystem::path(folder) / c.name;
    std::filesystem::create_directories(home);
    io::write_mesh(home / "truth.stl", c.truth), io::write_mesh(home / "start.stl", c.start);
    job.start_file = home / "start.stl";
    for (workflow::SemInput& input : job.images) {
      input.file = home / input.file;
      Image image;
      image.placement() = input.image.placement();
      Grid<float> values(c.columns, c.rows);
      std::ranges::copy(input.image.values.data(), values.data().begin());
      image.channels = {{"SE", "1", values}};
      io::write_image(input.file, image);
    }
    job.folder = home / "refined";
  }
  fmt::print(stderr, "images made\n");
  const auto begin = std::chrono::steady_clock::now();
  workflow::Reporter reporter;
  reporter.on_stage = [&](const std::string& stage) {
    fmt::print(stderr, "  {} {:.0f} s\n", stage, seconds_since(begin));
  };
  reporter.on_progress = [&](double done, double total, std::string_view) {
    fmt::print(stderr, "  {:.3f} {:.0f} s\n", done / total, seconds_since(begin));
  };
  const workflow::RefineSummary s = workflow::run(job, reporter);
  const double took = seconds_since(begin);
  const TriangleTree truth(c.truth);
  Score before, told, untold;
  const std::vector<Vec3> normals = vertex_normals(s.mesh), first = vertex_normals(s.before);
  constexpr double sensitive = 3;  // nm
  for (std::size_t v = 0; v < normals.size(); ++v) {
    if (s.deviation_nm[v] == 0 || s.displacement_nm[v] == 0) continue;
    double information = 0;
    for (const std::vector<double>& view : s.sensitivity) information += view[v] * view[v];
    const double off = off_nm(s.mesh.vertices_nm[v], normals[v], truth);
    const bool seen = information > 1 / (sensitive * sensitive);
    (seen ? told : untold).add(off, s.deviation_nm[v]);
    if (seen) before.add(off_nm(s.before.vertices_nm[v], first[v], truth), 1);
  }
  fmt::print("{}: {:.0f} s, {:.1f} million primaries, {} triangles, {} self-intersections{}\n",
             c.name, took, 1e-6 * static_cast<double>(s.primaries), s.mesh.triangles.size(),
             s.self_intersections, s.reasons.empty() ? "" : ", not trusted: " + s.reasons.front());
  fmt::print("  where an image tells: {} (start: {:.2f} nm)\n  elsewhere: {}\n", told.words(),
             std::sqrt(before.squares / std::max(1.0, before.count)), untold.words());
  if (c.line_height_nm > 0)
    for (const bool right : {false, true}) {
      const Lean found = lean_of(s.mesh, s, right, c.line_height_nm);
      fmt::print("  {} wall leans out by {:.2f} ± {:.2f} nm, {:.2f} true: off by {:.2f}\n",
                 right ? "right" : "left", found.value, found.error, c.lean_nm,
                 found.value - c.lean_nm);
    }
  for (std::size_t v = 0; v < s.images.size(); ++v)
    fmt::print(
        "  image {}: {:.1f} % unexplained, {:.1f} % before; tilt {:.2f} deg, bend {:.3f}, "
        "blur {:.2f} nm2\n",
        v + 1, 100 * s.images[v].unexplained, 100 * s.images[v].unexplained_before,
        s.images[v].tilt_deg, s.images[v].state.bend, s.images[v].state.blur_nm2);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : "";
  const std::string only = argc > 2 ? argv[2] : "";
  const auto seed = static_cast<std::uint64_t>(argc > 3 ? std::atoi(argv[3]) : 1);
  const bool own = argc > 4 && std::string(argv[4]) == "own";
  workflow::CachedLibraries libraries(io::cache_folder(""));
  for (const Case& c : all_cases()) {
    bool wanted = only.empty();
    for (const std::string_view name : split(only, ",")) wanted = wanted || name == c.name;
    if (!wanted) continue;
    try {
      measure(c, folder, 1000 * seed, own, libraries);
    } catch (const std::exception& e) {
      fmt::print("{}: {}\n", c.name, e.what());
    }
  }
  return 0;
}
