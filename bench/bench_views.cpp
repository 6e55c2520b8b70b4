// SPDX-License-Identifier: GPL-3.0-or-later
// How far surfaces of lines are off that come from one or more SEM images, with a scan and without,
// whether their errors hold, and how long that takes. The images are by the other tier of physics:
//   bench_views [CASES [FIRST [FOLDER [ONLY]]]]   with a folder (or ""), inputs go there; ONLY:
//   what
//                                                 to fit alone, as "one view,two views and a scan"
//   bench_views --heights MODEL.json [CASES [FIRST [FOLDER]]]   the reconstruction of heights
//   beside
//   bench_views --chart CHART.svg [...]   error against time of all that is measured
// Lines 100 nm high, of drawn width, wall angle and pitch, pixels of 4 nm, 150 electrons per pixel;
// tilts of 0 and 3 degrees to both sides, said to 0.05 degrees; BSE by quadrants; a scan of 12 nm
// pitch by a tip of 15 nm. Without a scan the height is said to be 100 +- 20 nm, as it is drawn.
// Baselines: edges by thresholds with walls of the height that is said; stereo, matching windows of
// 9 pixels in 8 rows of two images; quadrants integrated, with the factor that suits the truth
// best.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "signal_file.h"
#include "surf/afm/morphology.h"
#include "surf/afm/noise.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/random.h"
#include "surf/core/words.h"
#include "surf/io/cache.h"
#include "surf/io/height_field_file.h"
#include "surf/io/plot.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/simulate.h"
#include "surf/profile/feature_shape.h"
#include "surf/workflow/libraries.h"
#include "surf/workflow/profile_job.h"
#include "surf/workflow/reconstruct_job.h"
#include "surf/workflow/tip_job.h"

namespace {

using namespace surf;

constexpr double pixel_nm = 4, spot_nm = 2, energy_ev = 1000, tilt_deg = 3;
constexpr int columns = 128, rows = 96;
constexpr double gain = 900, offset = 120;

struct Case {
  FeatureShape shape;
  double said_nm = 100;  // the height, where nothing shows it
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
  c.said_nm = within(80, 120);
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

/// An image by SE, and by each quadrant.
std::vector<PlacedImage> images_of(const Case& c, double tilt, double azimuth_deg,
                                   std::uint64_t seed, mc::LibrarySource& libraries) {
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
  const std::vector<mc::Detector> quadrants = mc::parse_detectors("quadrants", "bench");
  options.detectors.insert(options.detectors.end(), quadrants.begin(), quadrants.end());
  mc::Physics physics;
  mc::parse_physics("inelastic=dielectric", physics);
  const mc::SimulationResult done =
      mc::simulate(mc::Scene(specimen, beam, scan, physics), options, {.libraries = &libraries});
  std::vector<PlacedImage> images;
  for (const std::size_t detector : {0, 2, 3, 4, 5}) {
    PlacedImage image;
    image.pitch_x_nm = image.pitch_y_nm = pixel_nm;
    image.origin_x_nm = 3 - 0.5 * (columns - 1) * pixel_nm;
    image.origin_y_nm = -0.5 * (rows - 1) * pixel_nm;
    image.values = Grid<double>(columns, rows);
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x)
        image.values(x, y) = offset + gain * done.yield(detector, x, y).mean;
    images.push_back(std::move(image));
  }
  return images;
}

HeightField truth_of(const Case& c) {
  HeightField truth{
      {pixel_nm, pixel_nm, 3 - 0.5 * (columns - 1) * pixel_nm, -0.5 * (rows - 1) * pixel_nm},
      Grid<double>(columns, rows)};
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) truth.z_nm(x, y) = height_nm(c.shape, truth.x_nm(x));
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
  const HeightField seen =
      dilate(dense, workflow::tip_by_shape({workflow::parse_tip_shape("cone:15nm,15deg", "tip"), 61,
                                            pitch / fine, pitch / fine},
                                           "tip"));
  HeightField scan{{pitch, pitch, dense.origin_x_nm, dense.origin_y_nm}, Grid<double>(n, m)};
  const AfmNoise noise{0.6, 0.1};
  const Grid<double> e = simulate_noise(noise, n, m, c.seed);
  for (int y = 0; y < m; ++y)
    for (int x = 0; x < n; ++x) scan.z_nm(x, y) = seen.z_nm(fine * x, fine * y) + e(x, y);
  return scan;
}

/// Root mean square difference, the median taken off, and the share within two deviations, heights
/// counted from the ground.
struct Off {
  double rms_nm = 0, within = 0;
};
Off off(const HeightField& found, const Grid<double>& deviation_nm, const HeightField& truth) {
  constexpr double of_ground_nm = 1;
  const double lowest = std::ranges::min(truth.z_nm.data());
  std::vector<double> d, of_ground;
  for (std::size_t i = 0; i < truth.z_nm.size(); ++i) {
    d.push_back(found.z_nm.data()[i] - truth.z_nm.data()[i]);
    if (truth.z_nm.data()[i] < lowest + of_ground_nm) of_ground.push_back(d.back());
  }
  const auto median_of = [](std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
  };
  const double median = median_of(d), ground = median_of(of_ground);
  Off out;
  for (std::size_t i = 0; i < d.size(); ++i) {
    out.rms_nm += std::pow(d[i] - median, 2) / static_cast<double>(d.size());
    if (!deviation_nm.empty())
      out.within +=
          (std::abs(d[i] - ground) <= 2 * deviation_nm.data()[i]) / static_cast<double>(d.size());
  }
  out.rms_nm = std::sqrt(out.rms_nm);
  return out;
}

struct Pooled {
  double n = 0, squares = 0, width2 = 0, height2 = 0, angle2 = 0, width_in = 0, height_in = 0,
         angle_in = 0, within = 0, seconds = 0;
  std::vector<double> each_seconds, each_rms_nm;

  void add(double rms_nm, double took) {
    ++n, squares += rms_nm * rms_nm, seconds += took;
    each_seconds.push_back(took), each_rms_nm.push_back(rms_nm);
  }
};

using Clock = std::chrono::steady_clock;
double since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// The widths of rows are drawn once: the feature is straight.
void judge(const char* what, const Case& c, const workflow::ProfileJob& job,
           const HeightField& truth, std::map<std::string, Pooled>& pooled) {
  const auto begin = Clock::now();
  try {
    const workflow::ProfileSummary s = workflow::run(job);
    const double seconds = since(begin);
    const Off o = off(s.surface, s.deviation_nm, truth);
    const Measured w = s.fit.left[profile_width], h = s.fit.left[profile_height],
                   a = s.fit.left[profile_angle];
    fmt::print(
        "  {:28} {:5.2f} nm ({:3.0f} % in two); width {:6.2f} +- {:4.2f}, height {:6.2f} +- "
        "{:5.2f}, angle {:5.2f} +- {:4.2f}; {:.0f} s{}{}{}\n",
        what, o.rms_nm, 100 * o.within, w.value - c.shape.width_nm, w.standard_error,
        h.value - c.shape.wall.height_nm, h.standard_error, a.value - c.shape.wall.angle_deg,
        a.standard_error, seconds,
        s.scan_height_nm ? fmt::format("; height by the scan {:.2f} +- {:.2f}",
                                       s.scan_height_nm->value - c.shape.wall.height_nm,
                                       s.scan_height_nm->standard_error)
                         : "",
        s.reasons.empty() ? "" : ": ", s.reasons.empty() ? "" : s.reasons.front());
    Pooled& p = pooled[what];
    const auto add = [](const Measured& m, double true_value, double& squares, double& in) {
      squares += std::pow(m.value - true_value, 2);
      in += std::abs(m.value - true_value) <= 2 * m.standard_error;
    };
    p.add(o.rms_nm, seconds), p.within += o.within;
    add(w, c.shape.width_nm, p.width2, p.width_in);
    add(h, c.shape.wall.height_nm, p.height2, p.height_in);
    add(a, c.shape.wall.angle_deg, p.angle2, p.angle_in);
  } catch (const std::exception& error) {
    fmt::print("  {:28} {}\n", what, error.what());
  }
  std::fflush(stdout);
}

/// Walls where thresholds see them, as wide as the rim's part on the ground's side.
void judge_thresholds(const Case& c, const workflow::ProfileJob& job, const HeightField& truth,
                      std::map<std::string, Pooled>& pooled) {
  const auto begin = Clock::now();
  const ThresholdEdges found = find_edges(job.sem.image, FeatureKind::line);
  HeightField surface = truth;
  double width = 0, pairs = 0;
  for (std::size_t e = 0; e + 1 < found.edges.size(); ++e)
    if (found.edges[e].feature == found.edges[e + 1].feature)
      width += found.edges[e + 1].place_nm - found.edges[e].place_nm, ++pairs;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      double nearest = HUGE_VAL, u = 0;
      for (const ImageEdge& e : found.edges) {
        const double d = surface.x_nm(x) - e.place_nm;
        if (std::abs(d) < nearest) nearest = std::abs(d), u = e.material_right ? d : -d;
      }
      surface.z_nm(x, y) = u > 0 ? c.said_nm : 0;
    }
  Pooled& p = pooled["thresholds"];
  const double seconds = since(begin), rms = off(surface, {}, truth).rms_nm;
  p.add(rms, seconds), p.width2 += std::pow(width / pairs - c.shape.width_nm, 2);
  p.height2 += std::pow(c.said_nm - c.shape.wall.height_nm, 2);
  fmt::print("  {:28} {:5.2f} nm; width {:6.2f}\n", "thresholds", rms,
             width / pairs - c.shape.width_nm);
}

void note(const char* what, Clock::time_point begin, const HeightField& surface,
          const HeightField& truth, std::map<std::string, Pooled>& pooled) {
  const double seconds = since(begin), rms = off(surface, {}, truth).rms_nm;
  pooled[what].add(rms, seconds);
  fmt::print("  {:28} {:5.2f} nm\n", what, rms);
}

/// Heights by how far windows of the upright image are displaced in the tilted one.
void judge_stereo(const PlacedImage& up, const PlacedImage& tilted, const HeightField& truth,
                  std::map<std::string, Pooled>& pooled) {
  constexpr int half = 4, band = 8, farthest = 3;
  const auto begin = Clock::now();
  HeightField surface = truth;
  const auto unlike = [&](int x, int from, int by) {
    double sum_a = 0, sum_b = 0, aa = 0, bb = 0, ab = 0, n = 0;
    for (int y = from; y < from + band; ++y)
      for (int k = -half; k <= half; ++k) {
        const double a = up.values(std::clamp(x + k, 0, columns - 1), y),
                     b = tilted.values(std::clamp(x + k + by, 0, columns - 1), y);
        sum_a += a, sum_b += b, aa += a * a, bb += b * b, ab += a * b, ++n;
      }
    const double both = ab - sum_a * sum_b / n;
    return -both / std::sqrt((aa - sum_a * sum_a / n) * (bb - sum_b * sum_b / n));
  };
  for (int from = 0; from + band <= rows; from += band)
    for (int x = 0; x < columns; ++x) {
      int best = 0;
      std::vector<double> costs;
      for (int by = -farthest - 1; by <= farthest + 1; ++by) costs.push_back(unlike(x, from, by));
      for (int by = -farthest; by <= farthest; ++by)
        if (costs[static_cast<std::size_t>(by + farthest + 1)] <
            costs[static_cast<std::size_t>(best + farthest + 1)])
          best = by;
      const double *c = &costs[static_cast<std::size_t>(best + farthest + 1)],
                   bend = c[-1] - 2 * c[0] + c[1],
                   by = best + (bend > 0 ? 0.5 * (c[-1] - c[1]) / bend : 0);
      // What is higher lies further along x in the image of a beam that is tilted to +x.
      for (int y = from; y < from + band; ++y)
        surface.z_nm(x, y) = by * pixel_nm / std::sin(tilt_deg * 3.14159265358979 / 180);
    }
  note("stereo", begin, surface, truth, pooled);
}

/// Slopes by the difference of opposite quadrants, integrated along rows; the factor and what every
/// row begins with suit the truth best.
void judge_quadrants(const PlacedImage& right, const PlacedImage& left, const HeightField& truth,
                     std::map<std::string, Pooled>& pooled) {
  const auto begin = Clock::now();
  Grid<double> integral(columns, rows);
  double ss = 0, sz = 0;
  for (int y = 0; y < rows; ++y) {
    double sum = 0, mean = 0, mean_z = 0;
    for (int x = 0; x < columns; ++x) {
      const double r = right.values(x, y) - offset, l = left.values(x, y) - offset;
      sum += (l - r) / std::max(l + r, 1.0) * pixel_nm;
      integral(x, y) = sum;
    }
    // Less a line, because unequal quadrants make one.
    for (int x = 0; x < columns; ++x) integral(x, y) -= sum * (x + 1) / columns;
    for (int x = 0; x < columns; ++x)
      mean += integral(x, y) / columns, mean_z += truth.z_nm(x, y) / columns;
    for (int x = 0; x < columns; ++x) {
      integral(x, y) -= mean;
      ss += integral(x, y) * integral(x, y);
      sz += integral(x, y) * (truth.z_nm(x, y) - mean_z);
    }
  }
  HeightField surface = truth;
  for (std::size_t i = 0; i < integral.size(); ++i)
    surface.z_nm.data()[i] = sz / ss * integral.data()[i];
  note("quadrants integrated", begin, surface, truth, pooled);
}

void judge_heights(const char* what, const workflow::ReconstructJob& job,
                   std::map<std::string, Pooled>& pooled) {
  const auto begin = Clock::now();
  try {
    const workflow::ReconstructSummary s = workflow::run(job);
    const double seconds = since(begin);
    if (s.truth) pooled[what].add(s.truth->rms_nm, seconds);
    if (s.truth)
      fmt::print("  {:28} {:5.2f} nm ({:3.0f} % in two); scan alone {:.2f}; {:.0f} s\n", what,
                 s.truth->rms_nm, 100 * s.truth->coverage_2, s.truth->start_rms_nm, seconds);
    else fmt::print("  {:28} {}\n", what, s.reasons.front());
  } catch (const std::exception& error) {
    fmt::print("  {:28} {}\n", what, error.what());
  }
  std::fflush(stdout);
}

void write_chart(const std::string& file, const std::map<std::string, Pooled>& pooled) {
  io::PlotPanel panel;
  panel.title = "Lines 100 nm high, walls of 85 degrees, pixels of 4 nm";
  panel.x = {"time on this machine (s)", true, {}};
  panel.y = {"root-mean-square error of the surface (nm)", true, {}};
  for (const auto& [what, p] : pooled)
    panel.series.push_back({what, p.each_seconds, p.each_rms_nm, {}, io::PlotStyle::points});
  io::Plot plot;
  plot.title = "Surfaces from several images: error against time";
  plot.panels = {panel};
  io::write_plot(file, plot);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  std::string chart;
  if (words.size() > 1 && words[0] == "--chart") {
    chart = words[1];
    words.erase(words.begin(), words.begin() + 2);
  }
  std::string model;
  if (words.size() > 1 && words[0] == "--heights") {
    model = words[1];
    words.erase(words.begin(), words.begin() + 2);
  }
  const int cases = !words.empty() ? std::atoi(words[0].c_str()) : 6,
            first = words.size() > 1 ? std::atoi(words[1].c_str()) : 2;
  const std::filesystem::path folder = words.size() > 2 ? words[2] : "";
  const std::vector<std::string_view> only =
      words.size() > 3 ? split(words[3], ",") : std::vector<std::string_view>();
  const auto wanted = [&](const char* what) {
    return only.empty() || std::ranges::find(only, what) != only.end();
  };
  workflow::CachedLibraries libraries(io::cache_folder(""));
  std::map<std::string, Pooled> pooled;
  for (int i = first; i < first + cases; ++i) {
    const Case c = draw(i);
    fmt::print("case {}: pitch {:.1f}, width {:.1f}, angle {:.2f} deg; said to be {:.0f} nm high\n",
               i, c.shape.pitch_nm, c.shape.width_nm, c.shape.wall.angle_deg, c.said_nm);
    const std::vector<PlacedImage> up = images_of(c, 0, 0, c.seed, libraries),
                                   to_x = images_of(c, tilt_deg, 0, c.seed + 100, libraries),
                                   to_minus_x =
                                       images_of(c, tilt_deg, 180, c.seed + 200, libraries);
    const HeightField truth = truth_of(c), scan = scan_of(c);
    if (!folder.empty()) {
      const std::filesystem::path own = folder / std::to_string(i);
      bench::write_signal(own / "up.tif", up[0]);
      bench::write_signal(own / "to_x.tif", to_x[0]);
      bench::write_signal(own / "to_minus_x.tif", to_minus_x[0]);
      bench::write_signal(own / "right.tif", up[1]);
      bench::write_signal(own / "left.tif", up[3]);
      io::write_height_field(own / "scan.gsf", scan, {});
      io::write_height_field(own / "truth.gsf", truth, {});
    }
    workflow::ProfileJob job;
    job.sem.image = up[0];
    job.height_nm = c.said_nm, job.height_error_nm = 20;
    job.material = io::find_material("Si", "bench");
    job.energy_ev = energy_ev, job.spot_nm = spot_nm;
    job.cache = io::cache_folder("");
    job.view_settings.tilt_error_deg = 0.05;
    judge_thresholds(c, job, truth, pooled);
    judge_stereo(up[0], to_x[0], truth, pooled);
    judge_quadrants(up[1], up[3], truth, pooled);
    if (wanted("one view")) judge("one view", c, job, truth, pooled);
    workflow::ProfileJob two = job;
    two.views.resize(1);
    two.views[0].image = to_x[0];
    two.view_settings.tilts_deg = {tilt_deg};
    if (wanted("two views")) judge("two views", c, two, truth, pooled);
    workflow::ProfileJob three = two;
    three.views.resize(2);
    three.views[1].image = to_minus_x[0];
    three.view_settings.tilts_deg = {tilt_deg, tilt_deg};
    three.view_settings.azimuths_deg = {0, 180};
    if (wanted("three views")) judge("three views", c, three, truth, pooled);
    workflow::ProfileJob quadrants = two;
    for (const int k : {1, 3}) {
      quadrants.views.emplace_back();
      quadrants.views.back().image = up[static_cast<std::size_t>(k)];
    }
    quadrants.view_settings.tilts_deg = {tilt_deg, 0, 0};
    quadrants.view_settings.signals = {"SE", "BSE-right", "BSE-left"};
    if (wanted("two views and quadrants"))
      judge("two views and quadrants", c, quadrants, truth, pooled);
    workflow::ProfileJob both = two;
    both.height_nm = 0, both.height_error_nm = 0;
    both.scan = scan;
    if (wanted("two views and a scan")) judge("two views and a scan", c, both, truth, pooled);
    if (model.empty()) continue;
    workflow::ReconstructJob heights;
    heights.model.file = model;
    heights.sem.emplace();
    heights.sem->image = up[0];
    heights.truth = truth;
    heights.afm.emplace();
    heights.afm->scan = scan;
    // Lines look alike a pitch away: the place is given as landmarks would, 5 nm off.
    heights.pose.transform = Affine{1, 0, 4, 0, 1, -3};
    judge_heights("heights, one view and a scan", heights, pooled);
    heights.views.resize(1);
    heights.views[0].image = to_x[0];
    heights.view_settings = two.view_settings;
    judge_heights("heights, two views, a scan", heights, pooled);
  }
  if (!chart.empty()) write_chart(chart, pooled);
  for (const auto& [what, p] : pooled)
    fmt::print(
        "{:28} {:5.2f} nm; width {:5.2f}, height {:5.2f} nm, angle {:4.2f} deg; within two "
        "{:3.0f}, {:3.0f}, {:3.0f} %, heights {:3.0f} %; {:.0f} s\n",
        what, std::sqrt(p.squares / p.n), std::sqrt(p.width2 / p.n), std::sqrt(p.height2 / p.n),
        std::sqrt(p.angle2 / p.n), 100 * p.width_in / p.n, 100 * p.height_in / p.n,
        100 * p.angle_in / p.n, 100 * p.within / p.n, p.seconds / p.n);
}
