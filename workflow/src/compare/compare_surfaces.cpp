// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "chain_steps.h"
#include "compare/compare_steps.h"
#include "surf/compare/surface_difference.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/mesh/mesh_height_field.h"

namespace surf::workflow {
namespace {

/// A surface on a grid, and what is known of its errors.
struct Gridded {
  HeightField field;
  std::optional<Grid<double>> deviation_nm;
  const char* from = "";  // where the deviation comes from
};

Gridded gridded(const MeasuredSurface& s, const std::optional<double>& told) {
  Gridded out{s.field, std::nullopt, ""};
  const Grid<double>& z = s.field.z_nm;
  if (told) out.deviation_nm = Grid<double>(z.width(), z.height(), *told), out.from = "told";
  else if (!s.deviation_nm.empty()) out.deviation_nm = s.deviation_nm, out.from = "its file";
  return out;
}

/// A mesh as it is seen from above, with the samples of the surface that it is compared with.
Gridded gridded(const TriangleMesh& mesh, const std::optional<double>& told, const Pitch& pitch,
                int threads, const Watch& watch) {
  MeshHeightFieldOptions options;
  options.pitch_nm = std::min(pitch.pitch_x_nm, pitch.pitch_y_nm);
  options.threads = threads;
  options.watch = watch;
  Gridded out{mesh_height_field(mesh, options), std::nullopt, "a mesh has none"};
  out.deviation_nm =
      Grid<double>(out.field.z_nm.width(), out.field.z_nm.height(), told.value_or(0));
  return out;
}

double usual(const Grid<double>& values, const Mask& valid) {
  std::vector<double> kept;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (valid.includes(i)) kept.push_back(values.data()[i]);
  if (kept.empty()) return 0;
  const auto middle = kept.begin() + static_cast<std::ptrdiff_t>(kept.size() / 2);
  std::nth_element(kept.begin(), middle, kept.end());
  return *middle;
}

}  // namespace

bool difference_of_surfaces(const CompareJob& job, const Reporter& reporter, CompareSummary& s,
                            double& least_spread) {
  const CompareParameters& p = job.parameters;
  const auto* scan_before = std::get_if<MeasuredSurface>(&job.before);
  const auto* scan_after = std::get_if<MeasuredSurface>(&job.after);
  begin(reporter, "surfaces");
  const Gridded before = scan_before
                             ? gridded(*scan_before, p.before_deviation_nm)
                             : gridded(std::get<TriangleMesh>(job.before), p.before_deviation_nm,
                                       scan_after->field, job.threads, reporter.watch());
  const Gridded after = scan_after
                            ? gridded(*scan_after, p.after_deviation_nm)
                            : gridded(std::get<TriangleMesh>(job.after), p.after_deviation_nm,
                                      scan_before->field, job.threads, reporter.watch());
  begin(reporter, "alignment");
  AlignOptions options;
  options.held = p.registered;
  if (p.largest_shift_nm) options.largest_shift_nm = *p.largest_shift_nm;
  options.least_overlap = p.least_overlap;
  options.watch = reporter.watch();
  s.alignment = align_surfaces(before.field, after.field, options);
  s.unit = "nm";
  if (!s.alignment.usable()) {
    s.reasons.push_back(s.alignment.reason);
    return false;
  }
  SurfaceDifference d = surface_difference(before.field, after.field, s.alignment);
  MeasuredDifference& m = s.difference;
  m.placement() = d.placement();
  m.difference = std::move(d.difference_nm);
  m.systematic = std::move(d.interpolation_nm);
  m.common = std::move(d.common_nm);
  m.valid = std::move(d.valid);
  if (before.deviation_nm && after.deviation_nm) {
    const Grid<double> moved =
        moved_deviation(before.field, after.field, *after.deviation_nm, s.alignment);
    m.deviation = *before.deviation_nm;
    for (std::size_t i = 0; i < m.deviation.size(); ++i)
      m.deviation.data()[i] = std::hypot(m.deviation.data()[i], moved.data()[i]);
    const double b = usual(*before.deviation_nm, m.valid), a = usual(moved, m.valid);
    if (a > 0 || b > 0) least_spread = std::hypot(b, d.averaged_share * a) / std::hypot(b, a);
    s.deviation_from = fmt::format("before: {}; after: {}", before.from, after.from);
    if (!(a > 0 || b > 0)) m.deviation = {};
  }
  if (m.deviation.empty()) {
    s.deviation_from = "the difference";
    if (before.deviation_nm && scan_before)
      reporter.note(
          "deviations are known of the surface before alone: those of the difference "
          "are estimated from it; `compare.after_deviation` says otherwise");
    else if (after.deviation_nm && scan_after)
      reporter.note(
          "deviations are known of the surface after alone: those of the difference are "
          "estimated from it; `compare.before_deviation` says otherwise");
  }
  s.before = {before.field.placement(), before.field.z_nm, m.valid};
  s.after = s.before;
  for (std::size_t i = 0; i < m.difference.size(); ++i)
    if (m.valid.includes(i)) s.after.values.data()[i] += m.difference.data()[i];
  return true;
}

}  // namespace surf::workflow
