// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/level_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf::workflow {
namespace {

void tell_doubts(const HoughSummary& s, const Reporter& reporter) {
  if (s.verdict == HoughVerdict::contested)
    reporter.warn(fmt::format(
        "no plane holds a clear majority: another one, {} {} at the centre, holds {:.1f} % of the "
        "image. "
        "Say which is meant with `scan.use` or `scan.exclude`, crop the scan, or choose another "
        "`level.method`",
        format_length(std::fabs(s.runner_up.height_nm - s.plane.height_nm)),
        s.runner_up.height_nm > s.plane.height_nm ? "higher" : "lower", 100 * s.runner_up_share));
  if (s.verdict == HoughVerdict::weak)
    reporter.warn(fmt::format(
        "no plane stands out: the best one holds {:.1f} % of the image, chance alone {:.1f} %. The "
        "surface is too rough for a substrate; `level.method=plane` may be what is wanted",
        100 * s.inlier_share, 100 * s.chance_share));
  if (!s.search_complete)
    reporter.note(
        "the search for planes ended at its limit: a better one, or a rival, may have been missed");
}

void take_off(LevelResult& result, const LevelParameters& p, const Mask& use, const Watch& watch) {
  result.substrate = use;
  switch (p.method) {
    case LevelMethod::none:
      return;
    case LevelMethod::polynomial:
      subtract(result.field, fit_polynomial(result.field, p.degree, use));
      return;
    case LevelMethod::plane:
      result.plane = fit_plane(result.field, use);
      break;
    case LevelMethod::hough: {
      result.hough = find_plane(result.field, {p.tolerance_nm.value_or(0), watch}, use);
      result.plane = result.hough->plane;
      result.substrate = std::move(result.hough->inliers);
    }
  }
  subtract(result.field, *result.plane);
  result.tilt_deg = std::max(result.tilt_deg, result.plane->tilt_deg());
}

}  // namespace

void describe(ParameterVisitor& visit, LevelParameters& p) {
  visit(p.method, {"hough", "plane", "polynomial", "none"},
        {.name = "level.method",
         .help = "Surface to subtract: the plane that most heights lie on (hough), the mean plane "
                 "(plane), a polynomial, or nothing (none)"});
  visit(p.degree, {.name = "level.degree",
                   .help = "Degree of the polynomial that is taken off",
                   .limits = within(0, 6)});
  visit(p.tolerance_nm, {.name = "level.tolerance",
                         .help = "Half the thickness of the substrate",
                         .unit = Unit::nm,
                         .limits = above(0),
                         .otherwise = "from the heights",
                         .level = Level::advanced});
  visit(p.rows, {"median", "difference"},
        {.name = "level.rows",
         .help = "Remove steps between scan lines, by the median of each line or of its "
                 "differences from the line below",
         .otherwise = "none"},
        "none");
}

LevelResult level(const HeightField& scan, const LevelParameters& p, const Mask& use,
                  const Reporter& reporter) {
  check_parameters(p);
  if (p.tolerance_nm && p.method != LevelMethod::hough)
    throw UsageError("`level.tolerance`", "only the method hough has one",
                     "Leave it out, or choose `level.method=hough`");
  LevelResult result;
  result.field = scan;
  take_off(result, p, use, reporter.watch(0, p.rows ? 0.5 : 1));
  if (p.rows) {
    result.rows = level_rows(result.field, *p.rows, result.substrate);
    take_off(result, p, use, reporter.watch(0.5, 1));
  }
  if (result.hough) tell_doubts(*result.hough, reporter);
  return result;
}

}  // namespace surf::workflow
