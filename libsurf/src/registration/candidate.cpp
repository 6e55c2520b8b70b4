// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/candidate.h"

#include <algorithm>
#include <cmath>

#include "registration/correlation.h"
#include "registration/mutual_information.h"
#include "surf/core/parallel.h"

namespace surf {
namespace {

// The true map may lie at a limit, and its estimate beyond.
constexpr double scale_room = 1.03, shear_room = 0.015, overlap_room = 0.9;

void refine_one(MapCandidate& candidate, const BlurLevel& level, RegistrationObjective objective,
                const Effort& effort, const RegistrationOptions& options) {
  const ThreePointMap before = candidate.corners;
  RegistrationStep step{level.blur_px, 0, 0, 0};
  if (objective == RegistrationObjective::correlation) {
    const CorrelationFit fit = fit_correlation(level, candidate.corners, effort.rounds,
                                               effort.iterations, effort.newton_steps);
    candidate.corners = fit.corners;
    candidate.score = fit.agreement.correlation;
    candidate.evidence = fit.agreement.evidence();
    candidate.samples = fit.agreement.samples;
    candidate.settled = fit.settled;
    step.evaluations = fit.evaluations;
  } else {
    Watch cancel;  // the caller reports the progress
    cancel.cancel = options.watch.cancel;
    const InformationFit fit =
        fit_information(level, options.mutual_information, candidate.corners, cancel);
    candidate.corners = fit.corners;
    candidate.score = fit.information;
    candidate.samples = overlap_of(level, fit.corners).size();
    candidate.evidence = static_cast<double>(candidate.samples) * fit.information;
    candidate.settled = fit.settled;
    step.evaluations = fit.evaluations;
  }
  step.score = candidate.score;
  const std::vector<std::size_t> overlap = overlap_of(level, candidate.corners);
  if (!overlap.empty())
    step.moved_px = distance_px(before, candidate.corners, moments_of(level, overlap));
  candidate.steps.push_back(step);
  candidate.places.push_back(candidate);
}

}  // namespace

void refine(std::vector<MapCandidate>& candidates, const BlurLevel& level,
            RegistrationObjective objective, const Effort& effort,
            const RegistrationOptions& options, const Watch& watch) {
  parallel_for(
      candidates.size(), resolve_threads(options.threads),
      [&](std::size_t i, int) { refine_one(candidates[i], level, objective, effort, options); },
      watch);
}

bool within_limits(const ThreePointMap& corners, const BlurLevel& level,
                   const ThreePointFrame& frame, const RegistrationOptions& options) {
  const AffineParts parts = parts_of(frame.affine(corners));
  const auto fits = [&](double scale) {
    return scale >= options.least_scale / scale_room && scale <= options.largest_scale * scale_room;
  };
  return fits(parts.scale_x) && fits(parts.scale_y) &&
         std::abs(parts.shear) <= options.largest_shear + shear_room &&
         overlap_share(level, corners, overlap_of(level, corners).size()) >=
             overlap_room * options.least_overlap;
}

void prune(std::vector<MapCandidate>& candidates, const BlurLevel& level,
           const ThreePointFrame& frame, const RegistrationOptions& options, double apart_px,
           std::size_t kept) {
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const MapCandidate& a, const MapCandidate& b) { return a.evidence > b.evidence; });
  std::vector<MapCandidate> good;
  std::vector<Moments> moments;
  for (MapCandidate& candidate : candidates) {
    if (good.size() == kept) break;
    if (!(candidate.evidence > 0) || !within_limits(candidate.corners, level, frame, options))
      continue;
    bool fresh = true;
    for (std::size_t i = 0; i < good.size() && fresh; ++i)
      fresh = distance_px(candidate.corners, good[i].corners, moments[i]) >= apart_px;
    if (!fresh) continue;
    moments.push_back(moments_of(level, overlap_of(level, candidate.corners)));
    good.push_back(std::move(candidate));
  }
  candidates = std::move(good);
}

}  // namespace surf
