// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/morphology_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "surf/afm/resample.h"
#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf::workflow {

const char* name(MorphologyOperation operation) {
  switch (operation) {
    case MorphologyOperation::erode:
      return "erode";
    case MorphologyOperation::dilate:
      return "dilate";
    case MorphologyOperation::open:
      return "open";
    case MorphologyOperation::close:
      break;
  }
  return "close";
}

void describe(ParameterVisitor& visit, MorphologyParameters& p) {
  visit(p.upsample, {.name = "morphology.upsample",
                     .help = "Samples per pixel to interpolate to; it changes opening, closing and "
                             "non-contact scans, which consist of two operations",
                     .limits = within(1, 32),
                     .level = Level::advanced});
  visit(p.distance_nm, {.name = "morphology.distance",
                        .help = "Distance between tip and surface in non-contact scans",
                        .unit = Unit::nm,
                        .limits = at_least(0),
                        .level = Level::advanced});
}

HeightField morphology(MorphologyOperation operation, const HeightField& field, const Tip& tip,
                       const MorphologyParameters& p, const Reporter& reporter) {
  check_parameters(p);
  const MorphologyOptions options{
      .upsample = p.upsample, .threads = p.threads, .watch = reporter.watch()};
  const bool kept_away = p.distance_nm > 0;
  switch (operation) {
    case MorphologyOperation::erode:
      return kept_away ? erode_noncontact(field, tip, p.distance_nm, options)
                       : erode(field, tip, options);
    case MorphologyOperation::dilate:
      return kept_away ? dilate_noncontact(field, tip, p.distance_nm, options)
                       : dilate(field, tip, options);
    case MorphologyOperation::open:
    case MorphologyOperation::close:
      break;
  }
  if (kept_away)
    throw UsageError("`morphology.distance`", "openings and closings know none", "Leave it out");
  return operation == MorphologyOperation::open ? opening(field, tip, options)
                                                : closing(field, tip, options);
}

Tip tip_for(Tip tip, const HeightField& scan, const std::string& name, const Reporter& reporter) {
  if (!tip.doubt.empty())
    reporter.warn(fmt::format(
        "{}: it says that this tip is not to be trusted: {}. What is made with it is not either",
        name, tip.doubt));
  const auto differ = [](double a, double b) { return std::abs(a - b) > 1e-6 * std::max(a, b); };
  if (differ(tip.pitch_x_nm, scan.pitch_x_nm) || differ(tip.pitch_y_nm, scan.pitch_y_nm)) {
    const Tip as_read = std::move(tip);
    tip = resampled(as_read, scan.pitch_x_nm, scan.pitch_y_nm);
    reporter.note(fmt::format(
        "{}: resampled from {} x {} pixels of {} to {} x {} of {}, as the scan has them", name,
        as_read.z_nm.width(), as_read.z_nm.height(), format_length(as_read.pitch_x_nm),
        tip.z_nm.width(), tip.z_nm.height(), format_length(scan.pitch_x_nm)));
  }
  if (tip.z_nm.width() > scan.z_nm.width() || tip.z_nm.height() > scan.z_nm.height())
    reporter.warn(
        fmt::format("{}: {} x {} pixels, more than the scan has: is it the tip, or the scan? What "
                    "cannot meet the scan plays no part",
                    name, tip.z_nm.width(), tip.z_nm.height()));
  return tip;
}

}  // namespace surf::workflow
