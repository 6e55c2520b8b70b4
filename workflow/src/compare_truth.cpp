// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare_truth.h"

#include <fmt/format.h>

#include <cmath>

#include "sem_frame.h"
#include "surf/afm/background.h"
#include "surf/core/error.h"

namespace surf::workflow {
namespace {

constexpr std::int64_t least_pixels = 16;

struct Differences {
  HeightField less;  // surface minus truth, valid where both are
  double mean = 0, rms = 0;
  std::int64_t count = 0;
};

Differences differences(const HeightField& surface, const HeightField& truth) {
  Differences d{surface, 0, 0, 0};
  d.less.valid = Mask(surface.z_nm.width(), surface.z_nm.height());
  double sum = 0, squared = 0;
  for (int y = 0; y < surface.z_nm.height(); ++y)
    for (int x = 0; x < surface.z_nm.width(); ++x) {
      if (!surface.is_valid(x, y) || !truth.is_valid(x, y)) continue;
      const double less = surface.z_nm(x, y) - truth.z_nm(x, y);
      d.less.z_nm(x, y) = less;
      d.less.valid(x, y) = 1;
      sum += less;
      squared += less * less;
      ++d.count;
    }
  if (d.count < least_pixels)
    throw InvalidInput(
        "`reconstruction.truth`",
        fmt::format("it has {} places in common with the surface", d.count),
        "Give heights in the frame of the SEM image, or of the scan where there is none");
  d.mean = sum / static_cast<double>(d.count);
  d.rms = std::sqrt(std::max(squared / static_cast<double>(d.count) - d.mean * d.mean, 0.0));
  return d;
}

double rms_of(const HeightField& field) {
  double squared = 0, count = 0;
  for (std::size_t i = 0; i < field.z_nm.size(); ++i)
    if (field.valid.data()[i]) squared += field.z_nm.data()[i] * field.z_nm.data()[i], ++count;
  return std::sqrt(squared / count);
}

}  // namespace

HeightField truth_on(const HeightField& surface, const HeightField& truth) {
  PlacedImage place;
  place.values = surface.z_nm;
  place.placement() = surface.placement();
  SurfaceUnderSem under = surface_under_sem(truth, place, Affine{});
  under.surface.valid = under.known;
  return under.surface;
}

double rms_off(const HeightField& surface, const HeightField& truth) {
  return differences(surface, truth_on(surface, truth)).rms;
}

TruthReport compare_with_truth(const Reconstruction& result, const HeightField& truth) {
  const HeightField there = truth_on(result.surface, truth);
  Differences d = differences(result.surface, there);
  TruthReport report;
  report.rms_nm = d.rms;
  report.offset_nm = d.mean;
  report.pixels = d.count;
  if (result.start.z_nm.width() == there.z_nm.width() &&
      result.start.z_nm.height() == there.z_nm.height())
    report.start_rms_nm = differences(result.start, there).rms;
  if (!result.deviation_nm.empty()) {
    std::int64_t within_1 = 0, within_2 = 0;
    for (std::size_t i = 0; i < d.less.z_nm.size(); ++i) {
      if (!d.less.valid.data()[i]) continue;
      const double off = std::abs(d.less.z_nm.data()[i] - d.mean),
                   deviation = result.deviation_nm.data()[i];
      within_1 += off <= deviation;
      within_2 += off <= 2 * deviation;
    }
    report.coverage_1 = static_cast<double>(within_1) / static_cast<double>(d.count);
    report.coverage_2 = static_cast<double>(within_2) / static_cast<double>(d.count);
  }
  subtract(d.less, fit_plane(d.less));
  report.plane_rms_nm = rms_of(d.less);
  return report;
}

}  // namespace surf::workflow
