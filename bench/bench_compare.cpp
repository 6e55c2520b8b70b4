// SPDX-License-Identifier: GPL-3.0-or-later
// How often changes are reported where there are none, and found where there are.
// Usage: bench_compare [PAIRS [FIRST]]
// Pairs of made-up surfaces of 256 x 256 nm in samples of 2 nm, shifted by fractions of a sample.
// Walls are ramps (these cases chose what the method is) or rounded (these judge it).
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>

#include "changing_surface.h"
#include "surf/compare/align_surfaces.h"
#include "surf/compare/find_changes.h"
#include "surf/compare/surface_difference.h"

namespace surf {
namespace {

using test::ChangingSurface;
using test::Measuring;
using test::WallShape;

struct Case {
  WallShape walls = WallShape::rounded;
  double wall_nm = 3, noise_nm = 0.3, correlation_px = 0, change_nm = 0, pitch_nm = 2;
  bool told = true;  // the deviations
};

struct Outcome {
  bool aligned = false, found = false;
  int places = 0, elsewhere = 0;
  double off_px = 0, stated_px = 0;  // of the shift, along x and y
  double mean_nm = 0, mean_error_nm = 0, threshold = 0;
  Point2 first;
};

Outcome run(const Case& c, std::uint64_t seed) {
  RandomStream random(seed, 1, 1);
  const auto between = [&](double a, double b) { return a + (b - a) * random.uniform(); };
  constexpr double size_nm = 256, side_nm = 20;
  const int px = int(size_nm / c.pitch_nm);
  ChangingSurface surface(seed, size_nm, c.walls, c.wall_nm);
  Measuring first{px, px, c.pitch_nm, 0, 0, c.noise_nm, c.correlation_px};
  first.seed = 2 * seed + 1'000'000;
  Measuring second = first;
  second.seed = first.seed + 1;
  second.x_nm = between(-8, 8), second.y_nm = between(-8, 8);
  second.lift_nm = between(-5, 5), second.tilt_x = between(-0.01, 0.01);
  const HeightField before = measured(surface, first);
  const double x = between(40, 216), y = between(40, 216);
  if (c.change_nm != 0) surface.add(x, y, side_nm, c.change_nm);
  const HeightField after = measured(surface, second);

  Outcome out;
  const SurfaceAlignment a = align_surfaces(before, after);
  out.aligned = a.verdict == AlignmentVerdict::aligned;
  if (!out.aligned) return out;
  out.off_px = (a.shift_nm.x - second.x_nm) / c.pitch_nm;
  out.stated_px = std::sqrt(a.covariance[0]) / c.pitch_nm;
  const SurfaceDifference d = surface_difference(before, after, a);
  MeasuredDifference m;
  m.placement() = d.placement();
  m.difference = d.difference_nm;
  if (c.told) m.deviation = Grid<double>(px, px, c.noise_nm * std::sqrt(2.0));
  m.systematic = d.interpolation_nm;
  m.common = d.common_nm;
  m.valid = d.valid;
  ChangeOptions options;
  options.least_spread = std::sqrt(0.5 * (1 + d.averaged_share * d.averaged_share));
  const Changes changes = find_changes(m, options);
  out.places = int(changes.places.size());
  out.threshold = changes.threshold;
  for (const ChangedPlace& place : changes.places) {
    const bool here = c.change_nm != 0 && std::abs(place.centre_nm.x - x) < side_nm &&
                      std::abs(place.centre_nm.y - y) < side_nm;
    if (here && place.mean * c.change_nm > 0 && !out.found) {
      out.found = true;
      out.mean_nm = place.mean, out.mean_error_nm = place.mean_error;
    }
    out.elsewhere += !here;
    if (!here && out.elsewhere == 1) out.first = place.centre_nm;
  }
  return out;
}

/// The interval of Wilson (1927, doi:10.1080/01621459.1927.10502953) of two standard errors.
std::string share(int part, int whole) {
  const double n = whole, p = part / n, z2 = 4;
  const double middle = (p + z2 / (2 * n)) / (1 + z2 / n),
               half = 2 * std::sqrt(p * (1 - p) / n + z2 / (4 * n * n)) / (1 + z2 / n);
  return fmt::format("{:4d} of {:4d}: {:5.1f} % ({:4.1f} to {:5.1f})", part, whole, 100 * p,
                     100 * (middle - half), 100 * (middle + half));
}

void row(const std::string& name, const Case& c, int pairs, std::uint64_t from, bool verbose) {
  int aligned = 0, alarmed = 0, found = 0;
  double squares = 0, stated = 0, bias = 0, mean = 0, error = 0, threshold = 0;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < pairs; ++i) {
    const Outcome o = run(c, from + std::uint64_t(i));
    if (!o.aligned) continue;
    ++aligned;
    alarmed += o.elsewhere > 0;
    found += o.found;
    bias += o.off_px, squares += o.off_px * o.off_px, stated += o.stated_px * o.stated_px;
    threshold += o.threshold;
    if (o.found) mean += o.mean_nm, error += o.mean_error_nm;
    if (verbose && o.elsewhere)
      fmt::print("  seed {} alarms {} at {:.0f}, {:.0f}; off {:.3f} px\n", from + std::uint64_t(i),
                 o.elsewhere, o.first.x, o.first.y, o.off_px);
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / pairs;
  fmt::print("{:<44} aligned {:3d}; false alarms {}", name, aligned, share(alarmed, aligned));
  if (c.change_nm != 0)
    fmt::print("; found {}, by {:.2f} +- {:.2f} nm", share(found, aligned), mean / found,
               error / found);
  fmt::print("; shift off by {:.4f} px, bias {:.4f}, stated {:.4f}; threshold {:.2f}; {:.2f} s\n",
             std::sqrt(squares / aligned), bias / aligned, std::sqrt(stated / aligned),
             threshold / aligned, seconds);
  std::fflush(stdout);
}

}  // namespace
}  // namespace surf

int main(int argc, char** argv) {
  using namespace surf;
  const int pairs = argc > 1 ? std::atoi(argv[1]) : 200;
  const std::uint64_t from = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  const std::string only = argc > 3 ? argv[3] : "";
  const auto want = [&](const char* name) { return only.empty() || only == name; };
  using enum WallShape;
  if (want("ramp")) row("no change, ramps of 3 nm", {ramp, 3, 0.3}, pairs, from, !only.empty());
  if (want("round"))
    row("no change, rounded walls of 3 nm", {rounded, 3, 0.3}, pairs, from, !only.empty());
  if (want("sharp"))
    row("no change, rounded walls of 0.5 nm", {rounded, 0.5, 0.3}, pairs, from, !only.empty());
  if (want("quiet"))
    row("no change, rounded, noise 0.1 nm", {rounded, 3, 0.1}, pairs, from, !only.empty());
  if (want("corr"))
    row("no change, rounded, noise alike over 2 px", {rounded, 3, 0.3, 2}, pairs, from,
        !only.empty());
  if (want("untold"))
    row("no change, rounded, deviations not told", {rounded, 3, 0.3, 0, 0, 2, false}, pairs, from,
        !only.empty());
  for (const double noise : {0.2, 0.5, 1.0, 2.0})
    for (const double alike : {0.0, 1.5})
      if (want("found"))
        row(fmt::format("2 nm over 20 x 20 nm, noise {} nm, alike {} px", noise, alike),
            {rounded, 3, noise, alike, 2}, std::max(1, pairs / 4), from, false);
  return 0;
}
