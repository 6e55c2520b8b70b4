// SPDX-License-Identifier: GPL-3.0-or-later
// Blind tip reconstruction of 512 x 512 pixels by 41 x 41 samples on one thread and two, beside
// Gwyddion's library on the same heights in the same run where it is installed, and how far the two
// tips are apart; a sweep of 40 thresholds; the twin experiment of the best estimate.
//   bench_blind_tip [--quick]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <tuple>

#include <fmt/core.h>

#include "surf/afm/best_tip.h"
#include "surf/afm/tip_sweep.h"
#include "twin_experiment.h"

#ifdef SEMSURF_GWYDDION
#include <libgwyddion/gwyddion.h>
#include <libprocess/gwyprocess.h>
#endif

namespace {

using namespace surf;

template <class Work>
double seconds(const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// Cones of 5 to 15 nm on a plane, seen by a lopsided paraboloid; white noise.
HeightField scan_of(int pixels, const Tip& tip, double noise_nm) {
  RandomStream random(1, 0, 0);
  HeightField out;
  Grid<double> surface(pixels, pixels);
  for (int k = 0; k < pixels * pixels / 600; ++k) {
    const int cx = static_cast<int>(random.uniform() * pixels),
              cy = static_cast<int>(random.uniform() * pixels);
    const double radius = 2 + 4 * random.uniform(), height = 5 + 10 * random.uniform();
    for (int y = std::max(0, cy - 6); y <= std::min(pixels - 1, cy + 6); ++y)
      for (int x = std::max(0, cx - 6); x <= std::min(pixels - 1, cx + 6); ++x)
        surface(x, y) = std::max(surface(x, y), height * (1 - std::hypot(x - cx, y - cy) / radius));
  }
  const Grid<double> noise = simulate_noise({0, noise_nm * noise_nm}, pixels, pixels, 2);
  out.z_nm = Grid<double>(pixels, pixels);
  const int r = tip.apex_x;
  for (int y = 0; y < pixels; ++y)
    for (int x = 0; x < pixels; ++x) {
      double most = -HUGE_VAL;
      for (int j = std::max(-r, y - pixels + 1); j <= std::min(r, y); ++j)
        for (int i = std::max(-r, x - pixels + 1); i <= std::min(r, x); ++i)
          most = std::max(most, surface(x - i, y - j) + tip.z_nm(i + r, j + r));
      out.z_nm(x, y) = most + noise(x, y);
    }
  return out;
}

Tip lopsided(int radius) {
  Tip tip;
  tip.z_nm = Grid<double>(2 * radius + 1, 2 * radius + 1);
  tip.apex_x = tip.apex_y = radius;
  for (int j = -radius; j <= radius; ++j)
    for (int i = -radius; i <= radius; ++i)
      tip.z_nm(i + radius, j + radius) =
          -(1.2 * i * i + j * j + 0.2 * i * j) / 24 - 0.1 * std::max(0, i);
  return tip;
}

#ifdef SEMSURF_GWYDDION
// Row 0 is the top there.
double by_gwyddion(const HeightField& scan, double threshold_nm, int size, Tip& out,
                   double& partial_seconds) {
  const int w = scan.z_nm.width(), h = scan.z_nm.height();
  GwyDataField* image = gwy_data_field_new(w, h, w, h, FALSE);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      gwy_data_field_get_data(image)[(h - 1 - y) * w + x] = scan.z_nm(x, y);
  GwyDataField* tip = gwy_data_field_new(size, size, size, size, TRUE);
  int count = -1;
  partial_seconds = seconds([&] {
    tip = gwy_tip_estimate_partial(tip, image, threshold_nm, FALSE, &count, nullptr, nullptr);
  });
  const double full = seconds([&] {
    tip = gwy_tip_estimate_full(tip, image, threshold_nm, FALSE, &count, nullptr, nullptr);
  });
  out.z_nm = Grid<double>(size, size);
  out.apex_x = out.apex_y = size / 2;
  const double top = gwy_data_field_get_max(tip);
  // Theirs is the tip itself, upside down: ours the structuring function.
  for (int j = 0; j < size; ++j)
    for (int i = 0; i < size; ++i)
      out.z_nm(i, j) = gwy_data_field_get_data(tip)[(size - 1 - j) * size + i] - top;
  g_object_unref(image);
  g_object_unref(tip);
  return full;
}
#endif

void compare(const HeightField& scan, double threshold_nm, int size) {
  BlindTipOptions options;
  options.width = options.height = size;
  options.threshold_nm = threshold_nm;
  options.border = false;
  BlindTip found;
  for (const int threads : {1, 2}) {
    options.threads = threads;
    const double s = seconds([&] { found = blind_tip({scan}, options); });
    fmt::print("threshold {} nm, {} thread{}: {:.3f} s, {} points in {} rounds\n", threshold_nm,
               threads, threads > 1 ? "s" : "", s, found.summary.points, found.summary.rounds);
  }
#ifdef SEMSURF_GWYDDION
  const Tip& tip = found.tip;
  Tip theirs;
  double partial = 0;
  gwy_process_type_init();
  const double full = by_gwyddion(scan, threshold_nm, size, theirs, partial);
  for (const bool mirrored : {false, true}) {
    const Tip t = mirrored ? reflected(theirs) : theirs;
    double most = 0, signed_most = 0;
    for (std::size_t k = 0; k < tip.z_nm.size(); ++k) {
      const double d = tip.z_nm.data()[k] - t.z_nm.data()[k];
      if (std::fabs(d) > most) most = std::fabs(d), signed_most = d;
    }
    fmt::print("  Gwyddion: partial {:.3f} s, full {:.2f} s more; tips {}at most {:.5f} nm apart\n",
               partial, full, mirrored ? "(mirrored) " : "", signed_most);
  }
#endif
}

}  // namespace

int main(int argc, char** argv) {
  const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
  const int pixels = quick ? 192 : 512, radius = quick ? 8 : 20;
  const Tip tip = lopsided(radius);
  const HeightField scan = scan_of(pixels, tip, 0.1);
  fmt::print("{0} x {0} pixels, {1} x {1} samples, noise 0.1 nm\n", pixels, 2 * radius + 1);
  for (const double threshold_nm : {1.0, 0.5}) compare(scan, threshold_nm, 2 * radius + 1);

  TipSweepOptions sweep;
  sweep.blind.width = sweep.blind.height = 2 * radius + 1;
  sweep.noise = {0, 0.01};
  TipSweep swept;
  const double s = seconds([&] { swept = sweep_tips({scan}, sweep); });
  fmt::print("sweep of {} thresholds, all threads: {:.1f} s, chosen {:.2f} nm\n", sweep.thresholds,
             s, swept.curve[swept.chosen].threshold_nm);

  for (const auto& [name, alpha, apart_nm] : {std::tuple("white noise", 0.0, 0.0),
                                              {"AR(1) noise, 0.6", 0.6, 0.0},
                                              {"double tip", 0.0, 4.5}}) {
    const AfmNoise noise{alpha, 0.09 * (1 - alpha * alpha)};
    double squares = 0, classical = 0, time = 0;
    const int seeds = quick ? 2 : 5;
    for (int seed = 1; seed <= seeds; ++seed) {
      const test::TwinExperiment twin =
          test::twin_experiment(noise, apart_nm, static_cast<std::uint64_t>(seed));
      BestTipOptions best;
      best.width = best.height = twin.tip.z_nm.width();
      best.noise = noise;
      time +=
          seconds([&] { squares += std::pow(twin.error_of(best_tip(twin.scans, best).tip), 2); }) /
          seeds;
      BlindTipOptions blind;
      blind.width = blind.height = best.width;
      blind.threshold_nm = 0.9;
      classical += std::pow(twin.error_of(blind_tip(twin.scans, blind).tip), 2);
    }
    fmt::print(
        "twin experiment, {}: best estimate {:.3f} nm in {:.2f} s, classical at 3 sigma {:.3f} "
        "nm\n",
        name, std::sqrt(squares / seeds), time, std::sqrt(classical / seeds));
  }
}
