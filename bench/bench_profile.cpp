// SPDX-License-Identifier: GPL-3.0-or-later
// How far widths, wall angles and roughness that `semsurf profile` finds are off, and whether their
// standard errors hold, on images whose truth is known:
//   bench_profile [CASES [FIRST [FOLDER]]]   with a folder, results and pictures of each case go
//                                            there
//   bench_profile --depths [CASES [FIRST [FOLDER [TILT [IMAGES]]]]]   holes whose depth is told a
//                                            fifth wrong; with a tilt of so many degrees 2 or
//                                            IMAGES further images, from all sides
// Cases 0 to 5 chose what the method is; the others judge it.
// Lines, trenches and holes of drawn width, angle and corners, 100 nm high, pixels of 4 nm, 150
// electrons per pixel; lines and trenches with rough edges. Images are made by the first tier of
// physics, as the profiles are, and by the dielectric tier, which they know nothing of. Beside each
// the threshold method.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "afm/normal_numbers.h"
#include "signal_file.h"
#include "surf/core/random.h"
#include "surf/io/cache.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/simulate.h"
#include "surf/profile/feature_shape.h"
#include "surf/workflow/libraries.h"
#include "surf/workflow/profile_job.h"

namespace {

using namespace surf;

constexpr double pixel_nm = 4, spot_nm = 2, energy_ev = 1000;
constexpr int columns = 100, rows = 128;
constexpr double gain = 900, offset = 120;

struct Case {
  FeatureShape shape;
  double sigma_nm = 0, correlation_nm = 25;
  bool dielectric = false;
  std::uint64_t seed = 1;
};

/// Displacements with an exponential correlation, one per place.
std::vector<double> rough_edge(const Case& c, int places, double distance_nm,
                               std::uint64_t stream) {
  NormalNumbers normal(c.seed, 100 + stream);
  const double keep = std::exp(-distance_nm / c.correlation_nm);
  std::vector<double> out;
  double now = c.sigma_nm * normal();
  for (int i = 0; i < places; ++i) {
    out.push_back(now);
    now = keep * now + c.sigma_nm * std::sqrt(1 - keep * keep) * normal();
  }
  return out;
}

/// A straight feature's sheet, cut along y and displaced edge by edge.
TriangleMesh rough(const Case& c, double reach_nm) {
  const TriangleMesh straight = feature_mesh(c.shape, reach_nm);
  // Its second row: the first is its rim.
  const std::size_t n = straight.vertices_nm.size() / 4;
  constexpr double distance_nm = 4;
  const int places = static_cast<int>(2 * reach_nm / distance_nm) + 1;
  TriangleMesh mesh;
  std::map<long, std::vector<double>> edges;
  // Edges lie at half the width from the middle of each period.
  const auto edge_of = [&](double x) {
    const double period = c.shape.pitch_nm > 0 ? c.shape.pitch_nm : 1e9;
    const double from_middle = x - period * std::round(x / period);
    return 2 * std::lround(x / period) + (from_middle > 0 ? 1 : 0);
  };
  for (int i = 0; i < places; ++i)
    for (std::size_t k = 0; k < n; ++k) {
      Vec3 v = straight.vertices_nm[n + k];
      v.y = -reach_nm + i * distance_nm;
      const bool inside = k > 0 && k + 1 < n;
      auto& edge = edges[edge_of(v.x)];
      if (edge.empty())
        edge = rough_edge(c, places, distance_nm, static_cast<std::uint64_t>(500 + edge_of(v.x)));
      if (inside && c.sigma_nm > 0) v.x += edge[static_cast<std::size_t>(i)];
      mesh.vertices_nm.push_back(v);
    }
  for (int i = 0; i + 1 < places; ++i)
    for (std::size_t k = 0; k + 1 < n; ++k) {
      const auto a = static_cast<std::uint32_t>(static_cast<std::size_t>(i) * n + k),
                 b = a + static_cast<std::uint32_t>(n);
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  return mesh;
}

/// By how much roughness makes the feature in the image wider, on average.
double wider_nm(const Case& c) {
  if (c.sigma_nm == 0) return 0;
  constexpr double distance_nm = 4, reach_nm = 1500;
  const int places = static_cast<int>(2 * reach_nm / distance_nm) + 1, from = (places - rows) / 2;
  double sum = 0;
  const auto left = rough_edge(c, places, distance_nm, 500),
             right = rough_edge(c, places, distance_nm, 501);
  for (int i = from; i < from + rows; ++i)
    sum += right[static_cast<std::size_t>(i)] - left[static_cast<std::size_t>(i)];
  return sum / rows;
}

mc::Physics physics_of(const Case& c) {
  mc::Physics physics;
  if (c.dielectric) mc::parse_physics("inelastic=dielectric", physics);
  return physics;
}

PlacedImage image_of(const Case& c, mc::LibrarySource& libraries, double tilt_deg = 0,
                     double azimuth_deg = 0) {
  const bool hole = c.shape.kind == FeatureKind::hole;
  mc::Specimen specimen;
  specimen.materials = {io::find_material("Si", "bench")};
  specimen.bodies.push_back({"feature", hole ? feature_mesh(c.shape, 1500) : rough(c, 1500), 0});
  mc::Beam beam;
  beam.energy_ev = energy_ev;
  beam.spot_nm = spot_nm;
  beam.tilt_deg = tilt_deg, beam.azimuth_deg = azimuth_deg;
  mc::Scan scan;
  scan.width = columns;
  scan.height = hole ? columns : rows;
  scan.pixel_x_nm = scan.pixel_y_nm = pixel_nm;
  scan.center_x_nm = 3;
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{150};
  options.method = mc::Method::replay;
  options.seed = c.seed + static_cast<std::uint64_t>(tilt_deg > 0 ? 7000 + azimuth_deg : 0);
  options.least_cascades = 100'000;
  const mc::SimulationResult done = mc::simulate(mc::Scene(specimen, beam, scan, physics_of(c)),
                                                 options, {.libraries = &libraries});
  PlacedImage image;
  image.pitch_x_nm = image.pitch_y_nm = pixel_nm;
  image.values = Grid<double>(scan.width, scan.height);
  for (int y = 0; y < scan.height; ++y)
    for (int x = 0; x < scan.width; ++x)
      image.values(x, y) = offset + gain * done.yield(0, x, y).mean;
  return image;
}

struct Pooled {
  double count = 0, width2 = 0, angle2 = 0, threshold2 = 0, width_in = 0, angle_in = 0,
         roughness2 = 0;
  double roughness_count = 0;
};

/// A hole of any depth.
Case draw_hole(int number) {
  RandomStream random(78, static_cast<std::uint64_t>(number), 0);
  const auto within = [&](double a, double b) { return a + (b - a) * random.uniform(); };
  Case c;
  c.shape.kind = FeatureKind::hole;
  c.shape.width_nm = within(70, 140);
  c.shape.wall = {within(60, 140), within(83, 89), within(1, 7), within(1, 7)};
  c.dielectric = number % 2 == 1;
  c.seed = 2000 + static_cast<std::uint64_t>(number);
  return c;
}

Case draw(int number) {
  RandomStream random(77, static_cast<std::uint64_t>(number), 0);
  const auto within = [&](double a, double b) { return a + (b - a) * random.uniform(); };
  Case c;
  constexpr FeatureKind kinds[] = {FeatureKind::line, FeatureKind::trench, FeatureKind::hole};
  c.shape.kind = kinds[number % 3];
  c.shape.width_nm = within(60, 110);
  c.shape.pitch_nm = c.shape.kind == FeatureKind::hole ? 0 : within(170, 200);
  c.shape.wall = {100, within(82, 89), within(1, 7), within(1, 7)};
  c.sigma_nm = c.shape.kind == FeatureKind::hole ? 0 : within(0.5, 1.5);
  c.correlation_nm = within(15, 40);
  c.dielectric = number / 3 % 2 == 1;
  c.seed = 1000 + static_cast<std::uint64_t>(number);
  return c;
}

void print(const char* what, const Pooled& p) {
  if (p.count == 0) return;
  fmt::print(
      "{}: width off by {:.2f} nm, threshold method {:.2f}; angle off by {:.2f} deg; within "
      "two standard errors {:.0f}, {:.0f} %",
      what, std::sqrt(p.width2 / p.count), std::sqrt(p.threshold2 / p.count),
      std::sqrt(p.angle2 / p.count), 100 * p.width_in / p.count, 100 * p.angle_in / p.count);
  if (p.roughness_count > 0)
    fmt::print("; sigma of edges off by {:.2f} nm", std::sqrt(p.roughness2 / p.roughness_count));
  fmt::print("\n");
}

}  // namespace

int main(int argc, char** argv) {
  const bool depths = argc > 1 && std::string(argv[1]) == "--depths";
  if (depths) --argc, ++argv;
  const int cases = argc > 1 ? std::atoi(argv[1]) : depths ? 8 : 12;
  const int first = argc > 2 ? std::atoi(argv[2]) : depths ? 2 : 6;
  const std::filesystem::path folder = argc > 3 ? argv[3] : "";
  const double tilt_deg = argc > 4 ? std::atof(argv[4]) : 0;
  const int tilted_images = argc > 5 ? std::atoi(argv[5]) : 2;
  double depth_squares = 0, depth_in = 0, depth_count = 0;
  workflow::CachedLibraries libraries(io::cache_folder(""));
  Pooled own, other;
  fmt::print(
      "  case                    width: true, found, threshold     angle: true, found       "
      "sigma: true, found   unexplained  s\n");
  for (int i = first; i < first + cases; ++i) {
    const Case c = depths ? draw_hole(i) : draw(i);
    workflow::ProfileJob job;
    job.sem.image = image_of(c, libraries);
    job.kind = c.shape.kind;
    job.height_nm = c.shape.wall.height_nm;
    if (depths) {
      job.height_nm *= i / 2 % 2 == 0 ? 0.8 : 1.2;
      job.height_error_nm = 0.25 * job.height_nm;
    }
    job.material = io::find_material("Si", "bench");
    job.energy_ev = energy_ev;
    job.spot_nm = spot_nm;
    job.cache = io::cache_folder("");
    if (tilt_deg > 0) {
      for (int side = 0; side < tilted_images; ++side) {
        const double azimuth_deg = 360.0 * side / tilted_images;
        workflow::SemInput view;
        view.image = image_of(c, libraries, tilt_deg, azimuth_deg);
        job.views.push_back(std::move(view));
        job.view_settings.tilts_deg.push_back(tilt_deg);
        job.view_settings.azimuths_deg.push_back(azimuth_deg);
      }
      job.view_settings.tilt_error_deg = 0.05;
    }
    if (!folder.empty()) {
      job.folder = folder / std::to_string(i);
      job.sem.file = folder / (std::to_string(i) + ".tif");
      bench::write_signal(job.sem.file, job.sem.image);
      for (std::size_t k = 0; k < job.views.size(); ++k) {
        job.views[k].file = folder / fmt::format("{}_{}.tif", i, k + 2);
        bench::write_signal(job.views[k].file, job.views[k].image);
      }
    }
    const auto begin = std::chrono::steady_clock::now();
    workflow::ProfileSummary s;
    try {
      s = workflow::run(job);
    } catch (const std::exception& error) {
      fmt::print("  {} {}: {}\n", name(job.kind), i, error.what());
      continue;
    }
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const double true_width = c.shape.width_nm + wider_nm(c);
    const Measured width = s.fit.left[profile_width], angle = s.fit.left[profile_angle];
    double threshold = 0;
    for (const Measured& w : s.threshold_widths_nm)
      threshold += w.value / static_cast<double>(s.threshold_widths_nm.size());
    fmt::print(
        "  {:6} {:10} {:7.2f} {:7.2f} +- {:4.2f} {:7.2f}   {:6.2f} {:6.2f} +- {:4.2f}   {:5.2f} "
        "{:5.2f} +- {:4.2f}  {:4.1f} %  {:3.0f} {}\n",
        name(c.shape.kind), c.dielectric ? "dielectric" : "own", true_width, width.value,
        width.standard_error, threshold, c.shape.wall.angle_deg, angle.value, angle.standard_error,
        c.sigma_nm, s.fit.edge_roughness.sigma_nm, s.fit.edge_roughness.sigma_error_nm,
        100 * s.discrepancy_share, seconds, s.reasons.empty() ? "" : s.reasons.front());
    if (depths) {
      const Measured depth = s.fit.left[profile_height];
      const double off = depth.value / c.shape.wall.height_nm - 1;
      fmt::print("    depth {:.1f}, told {:.1f}, found {:.1f} +- {:.1f}: off by {:.1f} %\n",
                 c.shape.wall.height_nm, job.height_nm, depth.value, depth.standard_error,
                 100 * off);
      ++depth_count, depth_squares += off * off;
      depth_in += std::abs(depth.value - c.shape.wall.height_nm) <= 2 * depth.standard_error;
    }
    std::fflush(stdout);
    Pooled& p = c.dielectric ? other : own;
    const double w = width.value - true_width, a = angle.value - c.shape.wall.angle_deg;
    ++p.count, p.width2 += w * w, p.angle2 += a * a;
    p.threshold2 += (threshold - true_width) * (threshold - true_width);
    p.width_in += std::abs(w) <= 2 * width.standard_error;
    p.angle_in += std::abs(a) <= 2 * angle.standard_error;
    if (c.sigma_nm > 0)
      ++p.roughness_count, p.roughness2 += std::pow(s.fit.edge_roughness.sigma_nm - c.sigma_nm, 2);
  }
  print("own physics", own);
  print("other tier", other);
  if (depth_count > 0)
    fmt::print("depths: off by {:.1f} %, within two standard errors {:.0f} %\n",
               100 * std::sqrt(depth_squares / depth_count), 100 * depth_in / depth_count);
}
