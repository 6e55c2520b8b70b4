// SPDX-License-Identifier: GPL-3.0-or-later
// How far surfaces that are reconstructed from several SEM images are off, on lines 100 nm high
// whose images the other tier of physics makes, and how long that takes:
//   bench_views MODEL.json [CASES [FIRST [FOLDER]]]   with a folder, inputs and results go there
// Lines of drawn width, wall angle, pitch and turn, pixels of 4 nm, 150 electrons per pixel; tilts
// of 0 and 3 degrees to both sides, said to 0.05 degrees; a scan of 12 nm pitch with a tip of 15 nm.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "surf/afm/morphology.h"
#include "surf/afm/noise.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/image.h"
#include "surf/core/random.h"
#include "surf/io/cache.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/simulate.h"
#include "surf/profile/feature_shape.h"
#include "surf/workflow/libraries.h"
#include "surf/workflow/reconstruct_job.h"
#include "surf/workflow/tip_job.h"

namespace {

using namespace surf;

constexpr double pixel_nm = 4, spot_nm = 2, energy_ev = 1000, tilt_deg = 3;
constexpr int columns = 128, rows = 96;
constexpr double gain = 900, offset = 120;

struct Case {
  FeatureShape shape;
  std::uint64_t seed = 1;
};

Case draw(int number) {
  RandomStream random(78, static_cast<std::uint64_t>(number), 0);
  const auto within = [&](double a, double b) { return a + (b - a) * random.uniform(); };
  Case c;
  c.shape.kind = FeatureKind::line;
  c.shape.pitch_nm = within(120, 200);
  c.shape.width_nm = within(0.4, 0.6) * c.shape.pitch_nm;
  c.shape.wall = {100, within(84, 86), within(2, 5), within(2, 5)};
  c.seed = 2000 + static_cast<std::uint64_t>(number);
  return c;
}

/// The height of lines along y, at a place.
double height_nm(const FeatureShape& f, double x) {
  const double from = std::fabs(x - f.pitch_nm * std::round(x / f.pitch_nm)),
               u = 0.5 * f.width_nm - from;
  const std::vector<Point2> wall = wall_profile(f.wall);
  if (u <= wall.front().x) return 0;
  for (std::size_t i = 1; i < wall.size(); ++i)
    if (u <= wall[i].x)
      return wall[i - 1].y +
             (wall[i].y - wall[i - 1].y) * (u - wall[i - 1].x) / (wall[i].x - wall[i - 1].x);
  return f.wall.height_nm;
}

PlacedImage image_of(const Case& c, double tilt, double azimuth_deg, std::uint64_t seed,
                     mc::LibrarySource& libraries) {
  mc::Specimen specimen;
  specimen.materials = {io::find_material("Si", "bench")};
  specimen.bodies.push_back({"feature", feature_mesh(c.shape, 1500), 0});
  mc::Beam beam;
  beam.energy_ev = energy_ev, beam.spot_nm = spot_nm;
  beam.tilt_deg = tilt, beam.azimuth_deg = azimuth_deg;
  mc::Scan scan;
  scan.width = columns, scan.height = rows;
  scan.pixel_x_nm = scan.pixel_y_nm = pixel_nm;
  scan.center_x_nm = 3;
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{150};
  options.method = mc::Method::replay;
  options.seed = seed;
  options.least_cascades = 100'000;
  mc::Physics physics;
  mc::parse_physics("inelastic=dielectric", physics);
  const mc::SimulationResult done = mc::simulate(mc::Scene(specimen, beam, scan, physics), options,
                                                 {.libraries = &libraries});
  PlacedImage image;
  image.pitch_x_nm = image.pitch_y_nm = pixel_nm;
  image.origin_x_nm = 3 - 0.5 * (columns - 1) * pixel_nm;
  image.origin_y_nm = -0.5 * (rows - 1) * pixel_nm;
  image.values = Grid<double>(columns, rows);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x)
      image.values(x, y) = offset + gain * done.yield(0, x, y).mean;
  return image;
}

HeightField truth_of(const Case& c) {
  HeightField truth{{pixel_nm, pixel_nm, 3 - 0.5 * (columns - 1) * pixel_nm,
                     -0.5 * (rows - 1) * pixel_nm},
                    Grid<double>(columns, rows)};
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x)
      truth.z_nm(x, y) = height_nm(c.shape, truth.x_nm(x));
  return truth;
}

/// A scan of 12 nm pitch, which sees more than the SEM images.
HeightField scan_of(const Case& c) {
  constexpr double pitch = 12;
  constexpr int n = 56, m = 44, fine = 6;
  HeightField dense{{pitch / fine, pitch / fine, -0.5 * (n - 1) * pitch, -0.5 * (m - 1) * pitch},
                    Grid<double>((n - 1) * fine + 1, (m - 1) * fine + 1)};
  for (int y = 0; y < dense.z_nm.height(); ++y)
    for (int x = 0; x < dense.z_nm.width(); ++x)
      dense.z_nm(x, y) = height_nm(c.shape, dense.x_nm(x));
  const HeightField seen = dilate(
      dense, workflow::tip_by_shape({workflow::parse_tip_shape("cone:15nm,15deg", "tip"), 61,
                                     pitch / fine, pitch / fine},
                                    "tip"));
  HeightField scan{{pitch, pitch, dense.origin_x_nm, dense.origin_y_nm}, Grid<double>(n, m)};
  const AfmNoise noise{0.6, 0.1};
  const Grid<double> e = simulate_noise(noise, n, m, c.seed);
  for (int y = 0; y < m; ++y)
    for (int x = 0; x < n; ++x) scan.z_nm(x, y) = seen.z_nm(fine * x, fine * y) + e(x, y);
  return scan;
}

void write(const std::filesystem::path& file, const PlacedImage& image) {
  std::filesystem::create_directories(file.parent_path());
  Image out;
  static_cast<Placement&>(out) = image;
  Grid<float> values(image.values.width(), image.values.height());
  std::ranges::copy(image.values.data(), values.data().begin());
  out.channels = {{"signal", "1", std::move(values)}};
  io::write_image(file, out);
}

void judge(const char* what, const workflow::ReconstructJob& job) {
  const auto begin = std::chrono::steady_clock::now();
  try {
    const workflow::ReconstructSummary s = workflow::run(job);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (!s.truth) {
      fmt::print("  {:34} {}: {}\n", what, name(s.verdict), s.reasons.front());
      return;
    }
    fmt::print("  {:34} {:6.2f} nm, AFM alone {:6.2f}, within two {:5.1f} %;", what,
               s.truth->rms_nm, s.truth->start_rms_nm, 100 * s.truth->coverage_2);
    for (const workflow::RegionReport& r : s.truth->regions)
      if (r.name == "edge" || r.name == "wall")
        fmt::print(" {} {:.2f} ({:.0f} %)", r.name, r.rms_nm, 100 * r.coverage_2);
    for (const ViewResult& v : s.result.views)
      fmt::print(" tilt {:.2f} to {:.0f}", v.pose.tilt_deg, v.pose.azimuth_deg);
    fmt::print(" {:.0f} s\n", seconds);
  } catch (const std::exception& error) {
    fmt::print("  {:34} {}\n", what, error.what());
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "bench_views MODEL.json [CASES [FIRST [FOLDER]]]\n");
    return 2;
  }
  const int cases = argc > 2 ? std::atoi(argv[2]) : 4, first = argc > 3 ? std::atoi(argv[3]) : 0;
  const std::filesystem::path folder = argc > 4 ? argv[4] : "";
  workflow::CachedLibraries libraries(io::cache_folder(""));
  for (int i = first; i < first + cases; ++i) {
    const Case c = draw(i);
    fmt::print("case {}: pitch {:.1f}, width {:.1f}, angle {:.2f}\n", i, c.shape.pitch_nm,
               c.shape.width_nm, c.shape.wall.angle_deg);
    workflow::ReconstructJob job;
    job.model.file = argv[1];
    job.sem.emplace();
    job.sem->image = image_of(c, 0, 0, c.seed, libraries);
    job.truth = truth_of(c);
    std::vector<workflow::SemInput> views(2);
    for (int k = 0; k < 2; ++k)
      views[static_cast<std::size_t>(k)].image =
          image_of(c, tilt_deg, 180.0 * k, c.seed + 100 * (1 + static_cast<std::uint64_t>(k)),
                   libraries);
    workflow::AfmInput afm;
    afm.scan = scan_of(c);
    if (!folder.empty()) {
      const std::filesystem::path own = folder / std::to_string(i);
      write(own / "up.tif", job.sem->image);
      write(own / "to_x.tif", views[0].image);
      write(own / "to_minus_x.tif", views[1].image);
      io::write_height_field(own / "scan.gsf", afm.scan, {});
      io::write_height_field(own / "truth.gsf", *job.truth, {});
    }
    job.afm = afm;
    // Lines look alike a pitch away: the place is given as landmarks would, 5 nm off.
    job.pose.transform = Affine{1, 0, 4, 0, 1, -3};
    job.view_settings.tilt_error_deg = 0.05;
    judge("scan and one view", job);
    job.views = {views[0]};
    job.view_settings.tilts_deg = {tilt_deg};
    judge("scan and two views", job);
    job.views = views;
    job.view_settings.tilts_deg = {tilt_deg, tilt_deg};
    job.view_settings.azimuths_deg = {0, 180};
    judge("scan and three views", job);
  }
}
