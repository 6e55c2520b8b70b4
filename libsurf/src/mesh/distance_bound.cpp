// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/distance_bound.h"

#include "core/argument.h"
#include "mesh/one_sided_bound.h"

namespace surf {
namespace {

double one_side(const TriangleMesh& from, const TriangleMesh& to, double enough_nm,
                const DistanceBoundOptions& options, const Watch& watch) {
  const TriangleTree tree(to, watch, options.threads);
  const OneSidedBound bound = bound_one_side(from, tree, {enough_nm, options.accuracy},
                                             options.threads, watch.part(0.1, 1));
  return bound.unproven.empty() ? bound.bound_nm : HUGE_VAL;
}

}  // namespace

DistanceBound bound_distance(const TriangleMesh& first, const TriangleMesh& second,
                             const DistanceBoundOptions& options) {
  require_positive(options.accuracy, "accuracy");
  validate(first);
  validate(second);
  const Watch& watch = options.watch;
  watch.report(0, 1);
  const double enough_nm = negligible_distance_nm(first, second);
  DistanceBound bound;
  bound.from_first_nm = one_side(first, second, enough_nm, options, watch.part(0, 0.5));
  bound.from_second_nm = one_side(second, first, enough_nm, options, watch.part(0.5, 1));
  return bound;
}

}  // namespace surf
