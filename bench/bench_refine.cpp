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
  std::vector<double> tilts_deg{15, 15}, azimuths_deg{0, 180};
  int columns = 64, rows = 40;
  double line_height_nm = 0;  ///< of a line; 0: it is none
  double lean_nm = 0;         ///< of its walls over their feet
  double depth_nm = 0;        ///< of a hole; 0: it is none
  double height_error_nm = 4;
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
  // An ellipse from where it meets the stem to its top.
  const double first = -std::acos(stem_radius / cap_radius), last = 0.49 * std::numbers::pi;
  for (int i = 1; i <= steps; ++i) {
    const double a = first + (last - first) * i / steps;
    loops.push_back(circle(cap_radius * std::cos(a),
                           stem_height + 0.5 * cap_height * (std::sin(a) - std::sin(first))));
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
          {tilt, tilt},
          {0, 180},
          64,
          16,
          100,
          100 * std::tan((angle - 90) * std::numbers::pi / 180)};
}

/// A contact hole, whose depth is told 20 % wrong: from above and from both sides.
Case hole_case(double depth, double told) {
  const auto hole = [&](double width, double angle, double to) {
    FeatureShape f;
    f.kind = FeatureKind::hole;
    f.width_nm = width;
    f.wall = {to, angle, 4, 3};
    return feature_mesh(f, 400);
  };
  return {fmt::format("hole{:g}", depth),
          hole(100, 86, depth),
          hole(105, 88, told),
          {0, 20, 20},
          {0, 0, 180},
          44,
          44,
          0,
          0,
          depth,
          0.25 * told};
}

std::vector<Case> all_cases() {
  return {
      line_case(100, 15),
      line_case(96, 10),
      line_case(88, 15),
      line_case(75, 15),
      {"mushroom", mushroom(25, 45, 62, 60), mushroom(30, 50, 57, 54), {20, 20}, {0, 180}, 56, 56},
      {"cube",
       cube_on_pillar(50, 40, 90, 70),
       cube_on_pillar(60, 46, 96, 66),
       {20, 20},
       {0, 180},
       56,
       56},
      hole_case(100, 120),
      hole_case(75, 60),
      hole_case(130, 105)};
}

PlacedImage image_of(const Case& c, std::size_t view, std::uint64_t seed, bool own,
                     mc::LibrarySource& libraries) {
  mc::Specimen specimen;
  specimen.materials = {io::find_material("Si", "bench")};
  specimen.bodies.push_back({"truth", c.truth, 0});
  mc::Beam beam;
  beam.energy_ev = energy_ev, beam.spot_nm = spot_nm;
  beam.tilt_deg = c.tilts_deg[view], beam.azimuth_deg = c.azimuths_deg[view];
  mc::Scan scan;
  scan.width = c.columns, scan.height = c.rows;
  scan.pixel_x_nm = scan.pixel_y_nm = pixel_nm;
  scan.center_x_nm = 2.5, scan.center_y_nm = -1;
  if (beam.tilt_deg > 0) scan.center_z_nm = 50;
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

/// Where images tell of what rises from the ground, and where they do not.
struct Errors {
  Score told, untold;
};

/// Less the shift along x and y that suits best: where the whole is no image tells.
Errors errors_of(const TriangleMesh& mesh, const workflow::RefineSummary& s, const Case& c) {
  constexpr double sensitive_nm = 3, ground_nm = 3;
  const TriangleTree truth(c.truth);
  const std::vector<Vec3> normals = vertex_normals(mesh);
  std::vector<std::size_t> vertices;
  std::vector<double> off(normals.size(), 0);
  std::vector<bool> seen(normals.size(), false);
  for (std::size_t v = 0; v < normals.size(); ++v) {
    if (s.deviation_nm[v] == 0 || std::abs(mesh.vertices_nm[v].z) < ground_nm) continue;
    double information = 0;
    for (const std::vector<double>& view : s.sensitivity) information += view[v] * view[v];
    seen[v] = information > 1 / (sensitive_nm * sensitive_nm);
    vertices.push_back(v);
  }
  Vec3 shift;
  constexpr int rounds = 5;  // the nearest place of the truth moves with the shift
  for (int k = 0; k < rounds; ++k) {
    double xx = 0, xy = 0, yy = 0, x = 0, y = 0;
    for (const std::size_t v : vertices) {
      off[v] = off_nm(mesh.vertices_nm[v] + shift, normals[v], truth);
      if (!seen[v]) continue;
      const Vec3& n = normals[v];
      xx += n.x * n.x, xy += n.x * n.y, yy += n.y * n.y, x -= n.x * off[v], y -= n.y * off[v];
    }
    const double determinant = xx * yy - xy * xy;
    if (determinant > 0)
      shift += {(yy * x - xy * y) / determinant, (xx * y - xy * x) / determinant, 0};
  }
  Errors out;
  for (const std::size_t v : vertices)
    (seen[v] ? out.told : out.untold).add(off[v], s.deviation_nm[v]);
  return out;
}

/// A length and its standard error, in nm.
struct Told {
  double value = 0, error = 0;
};

/// The standard deviation of a sum of the vertices' places, each times its weight.
double deviation_of(const workflow::RefineSummary& s, const std::vector<Vec3>& weights) {
  std::vector<double> by(s.modes.size(), 0);
  for (std::size_t k = 0; k < by.size(); ++k)
    for (const MeshMode::Move& m : s.modes[k].moves) by[k] += dot(weights[m.vertex], m.by);
  double variance = 0;
  for (std::size_t k = 0; k < by.size(); ++k)
    for (std::size_t l = 0; l < by.size(); ++l)
      variance += by[k] * by[l] * s.covariance[k * by.size() + l];
  return std::sqrt(variance);
}

/// How far a wall leans out over its foot.
Told lean_of(const TriangleMesh& mesh, const workflow::RefineSummary& s, bool right,
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
  std::vector<Vec3> weights;
  for (const double w : weight) weights.push_back({w, 0, -slope * w});
  return {(right ? 1 : -1) * slope * height, deviation_of(s, weights) * height};
}

/// How deep a hole is under its surroundings in view.
Told depth_of(const TriangleMesh& mesh, const workflow::RefineSummary& s, double width) {
  std::vector<Vec3> weights(mesh.vertices_nm.size());
  for (const bool bottom : {true, false}) {
    std::vector<std::size_t> there;
    for (std::size_t v = 0; v < weights.size(); ++v) {
      const double r = std::hypot(mesh.vertices_nm[v].x, mesh.vertices_nm[v].y);
      if (bottom ? r < 0.3 * width : r > 0.65 * width && r < 0.85 * width) there.push_back(v);
    }
    for (const std::size_t v : there)
      weights[v].z = (bottom ? -1.0 : 1.0) / static_cast<double>(there.size());
  }
  Told out;
  for (std::size_t v = 0; v < weights.size(); ++v)
    out.value += dot(weights[v], mesh.vertices_nm[v]);
  out.error = deviation_of(s, weights);
  return out;
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
  job.tilts_deg = c.tilts_deg, job.azimuths_deg = c.azimuths_deg;
  job.height_error_nm = c.height_error_nm;
  job.smooth_rounds = 4;
  if (c.line_height_nm > 0 || c.depth_nm > 0) {  // they have no other shape, and few pixels
    job.bump_rounds = 0;
    job.electrons = 600, job.effect_electrons = 50;
  }
  job.cache = io::cache_folder("");
  for (std::size_t v = 0; v < c.tilts_deg.size(); ++v)
    job.images.push_back(
        {image_of(c, v, seed + 180 * v, own, libraries), fmt::format("{}-{}.exr", c.name, v + 1)});
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
  int twentieths = 0;
  reporter.on_progress = [&](double done, double total, std::string_view) {
    const int now = static_cast<int>(20 * done / total);
    if (now != twentieths) fmt::print(stderr, "  {} % {:.0f} s\n", 5 * now, seconds_since(begin));
    twentieths = now;
  };
  const workflow::RefineSummary s = workflow::run(job, reporter);
  const double took = seconds_since(begin);
  const Errors before = errors_of(s.before, s, c), after = errors_of(s.mesh, s, c);
  fmt::print("{}: {:.0f} s, {:.1f} million primaries, {} triangles, {} self-intersections{}\n",
             c.name, took, 1e-6 * static_cast<double>(s.primaries), s.mesh.triangles.size(),
             s.self_intersections, s.reasons.empty() ? "" : ", not trusted: " + s.reasons.front());
  fmt::print("  where an image tells: {}\n    start: {}\n  elsewhere: {}\n", after.told.words(),
             before.told.words(), after.untold.words());
  if (c.line_height_nm > 0)
    for (const bool right : {false, true}) {
      const Told found = lean_of(s.mesh, s, right, c.line_height_nm);
      fmt::print("  {} wall leans out by {:.2f} ± {:.2f} nm, {:.2f} true: off by {:.2f}\n",
                 right ? "right" : "left", found.value, found.error, c.lean_nm,
                 found.value - c.lean_nm);
    }
  if (c.depth_nm > 0) {
    const Told found = depth_of(s.mesh, s, 100), first_guess = depth_of(s.before, s, 100);
    fmt::print("  depth {:.1f} ± {:.1f} nm, told as {:.1f}, {:.1f} true: off by {:.1f} %\n",
               found.value, found.error, first_guess.value, c.depth_nm,
               100 * (found.value / c.depth_nm - 1));
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
