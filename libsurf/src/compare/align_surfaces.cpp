// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/compare/align_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "compare/align_fit.h"
#include "core/cubic_sample.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/registration/find_shift.h"

namespace surf {
namespace {

constexpr int fewest_samples = 16;  // along x and y
constexpr double most_pitch_ratio = 4;
constexpr double same_pitch = 1e-3;
constexpr int most_starts = 4;
// A second shift rivals the best one if the data prefer it by fewer e-foldings of likelihood.
constexpr double rival_e_foldings = 6;
constexpr double most_place_error_px = 1.5;

void check(const HeightField& before, const HeightField& after, const AlignOptions& o) {
  validate(before, "surface before"), validate(after, "surface after");
  for (const auto* f : {&before, &after})
    if (std::min(f->z_nm.width(), f->z_nm.height()) < fewest_samples)
      throw InvalidInput(f == &before ? "surface before" : "surface after",
                         fmt::format("it has {} x {} samples", f->z_nm.width(), f->z_nm.height()),
                         fmt::format("Give one of at least {0} x {0}", fewest_samples));
  for (const double ratio :
       {before.pitch_x_nm / after.pitch_x_nm, before.pitch_y_nm / after.pitch_y_nm})
    if (!(ratio < most_pitch_ratio && ratio > 1 / most_pitch_ratio))
      throw InvalidInput(
          "surface after",
          fmt::format("its samples are {} apart, those of the surface before {}",
                      format_length(after.pitch_x_nm), format_length(before.pitch_x_nm)),
          "Resample one of them");
  if (!(o.largest_shift_nm >= 0))
    throw UsageError("`compare.largest_shift`",
                     fmt::format("{} is out of range", o.largest_shift_nm),
                     "Give a length of 0 or more");
  if (!(o.least_overlap > 0 && o.least_overlap <= 1))
    throw UsageError("`compare.least_overlap`", fmt::format("{} is out of range", o.least_overlap),
                     "Give a share above 0, up to 1");
}

/// The field at another pitch, without its plane, for the search of whole pixels.
PlacedImage searched(const HeightField& smooth, const Pitch& pitch) {
  PlacedImage out{smooth.placement(), smooth.z_nm, smooth.valid};
  if (std::abs(smooth.pitch_x_nm / pitch.pitch_x_nm - 1) > same_pitch ||
      std::abs(smooth.pitch_y_nm / pitch.pitch_y_nm - 1) > same_pitch) {
    out.pitch() = pitch;
    const auto count = [](int n, double from, double to) {
      return std::max(2, int((n - 1) * from / to + 1e-6) + 1);
    };
    const int w = count(smooth.z_nm.width(), smooth.pitch_x_nm, pitch.pitch_x_nm),
              h = count(smooth.z_nm.height(), smooth.pitch_y_nm, pitch.pitch_y_nm);
    out.values = Grid<double>(w, h);
    out.valid = Mask(w, h);
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        const double u = x * pitch.pitch_x_nm / smooth.pitch_x_nm,
                     v = y * pitch.pitch_y_nm / smooth.pitch_y_nm;
        const CubicSample at(u, v, smooth.z_nm.width(), smooth.z_nm.height());
        bool whole = true;
        for (int j = 1; j < 3; ++j)
          for (int i = 1; i < 3; ++i) whole = whole && smooth.is_valid(at.column[i], at.row[j]);
        out.valid(x, y) = whole;
        if (whole) out.values(x, y) = at.value(smooth.z_nm);
      }
  }
  take_plane_off(out.values, out.valid);
  return out;
}

/// Shifts to begin with, best first.
std::vector<Point2> starts_of(const HeightField& before, const HeightField& after,
                              const AlignOptions& o) {
  std::vector<Point2> out;
  constexpr int searched_peaks = 64;
  constexpr double weak = 0.6;  // a start that correlates less, beside the first one, is no rival
  double first = 0;
  for (const ImageShift& s :
       find_shifts(searched(before, before.pitch()), searched(after, before.pitch()),
                   searched_peaks, o.least_overlap)) {
    const double slack_x = 0.5 * before.pitch_x_nm, slack_y = 0.5 * before.pitch_y_nm;
    if (std::abs(s.x_nm) > o.largest_shift_nm + slack_x ||
        std::abs(s.y_nm) > o.largest_shift_nm + slack_y)
      continue;
    if (out.empty()) first = s.correlation;
    if (s.correlation < weak * first) continue;
    out.push_back({s.x_nm, s.y_nm});
    if (int(out.size()) == most_starts) break;
  }
  if (out.empty()) out.push_back({0, 0});
  return out;
}

/// The evidence that chance alone gives for the best of all shifts, and as much again for safety.
double evidence_of_chance(double independent) {
  constexpr double margin = 1.5, shifts_per_sample = 4;
  return std::sqrt(2 * std::log(std::max(2.0, shifts_per_sample * independent))) + margin;
}

void judge(SurfaceAlignment& out, const AlignFit& best, const std::vector<AlignFit>& fits) {
  if (out.evidence < evidence_of_chance(best.independent)) {
    out.verdict = AlignmentVerdict::unrelated;
    out.reason = fmt::format(
        "the surfaces agree nowhere more than chance allows (correlation {:.2f}). Are they of one "
        "place? Where nothing stands out of the noise, or the places that the files state are "
        "right, say `compare.registered`",
        out.correlation);
    return;
  }
  // Chance lays some walls on others; those of one specimen all lie on their own.
  if (out.place_error_px > most_place_error_px) {
    out.verdict = AlignmentVerdict::unrelated;
    out.reason = fmt::format(
        "where the surfaces agree best (correlation {:.2f}), most walls lie beside each other, "
        "typically by {:.1f} samples. Are they of one place? If so, say `compare.registered`",
        out.correlation, out.place_error_px);
    return;
  }
  out.verdict = AlignmentVerdict::ambiguous;
  if (!best.determined) {
    out.reason =
        "the surfaces fit as well when they slide along each other, as along a straight "
        "wall. Say `compare.registered` if the places that the files state are right";
    return;
  }
  for (const AlignFit& other : fits) {
    const double dx = other.shift_nm.x - best.shift_nm.x, dy = other.shift_nm.y - best.shift_nm.y;
    if (&other == &best || !other.usable ||
        std::hypot(dx, dy) < 3 * std::hypot(best.pitch.pitch_x_nm, best.pitch.pitch_y_nm))
      continue;
    const double unexplained = std::max(1e-12, 1 - best.correlation * best.correlation),
                 others = std::max(1e-12, 1 - other.correlation * other.correlation);
    if (0.5 * best.independent * std::log(others / unexplained) > rival_e_foldings) continue;
    out.reason = fmt::format(
        "they fit nearly as well when `after` is shifted by ({}, {}) instead of ({}, {}). Say "
        "`compare.largest_shift`, or `compare.registered` if the places that the files state are "
        "right",
        format_length(other.shift_nm.x), format_length(other.shift_nm.y),
        format_length(best.shift_nm.x), format_length(best.shift_nm.y));
    return;
  }
  out.verdict = AlignmentVerdict::aligned;
}

}  // namespace

SurfaceAlignment align_surfaces(const HeightField& before, const HeightField& after,
                                const AlignOptions& o) {
  check(before, after, o);
  const double reach_x = std::max(before.pitch_x_nm, after.pitch_x_nm),
               reach_y = std::max(before.pitch_y_nm, after.pitch_y_nm);
  const HeightField resting = smoothed(before, reach_x, reach_y),
                    moving = smoothed(after, reach_x, reach_y);
  o.watch.report(0, 1);
  std::vector<AlignFit> fits;
  if (o.held) fits.push_back(fit_alignment(resting, moving, {0, 0}, true, o.watch));
  else
    for (const Point2 start : starts_of(resting, moving, o)) {
      fits.push_back(fit_alignment(resting, moving, start, false, o.watch));
    }
  const AlignFit& best = *std::ranges::max_element(
      fits, {}, [](const AlignFit& f) { return f.usable ? f.correlation : -2; });
  if (o.held && !best.usable)
    throw InvalidInput("surfaces", "hardly any of their samples lie on each other",
                       "Correct the places that the files state, or leave out "
                       "`compare.registered`");
  SurfaceAlignment out;
  out.shift_nm = best.shift_nm;
  out.lift_nm = best.lift_nm;
  out.tilt_x = best.tilt_x, out.tilt_y = best.tilt_y;
  out.centre_nm = best.centre_nm;
  out.covariance = best.covariance;
  out.place_error_px = best.place_error_px;
  out.correlation = best.correlation;
  out.overlap = best.overlap;
  out.evidence = std::atanh(std::clamp(best.correlation, -1 + 1e-12, 1 - 1e-12)) *
                 std::sqrt(std::max(best.independent - 3, 1.0));
  if (o.held) out.verdict = AlignmentVerdict::held;
  else judge(out, best, fits);
  o.watch.report(1, 1);
  return out;
}

}  // namespace surf
