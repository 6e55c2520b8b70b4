// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/trial.h"

#include <algorithm>
#include <cmath>

#include "registration/correlation.h"
#include "registration/mutual_information.h"
#include "surf/core/parallel.h"

namespace surf {
namespace {

// The true map may lie at a limit, and its estimate beyond.
constexpr double scale_room = 1.03, shear_room = 0.015, overlap_room = 0.9;

void refine_one(Trial& trial, const BlurLevel& level, RegistrationObjective objective,
                const Effort& effort, const RegistrationOptions& options) {
  const Corners before = trial.corners;
  RegistrationStep step{level.blur_px, 0, 0, 0};
  if (objective == RegistrationObjective::correlation) {
    const CorrelationFit fit = fit_correlation(level, trial.corners, effort.rounds,
                                               effort.iterations, effort.newton_steps);
    trial.corners = fit.corners;
    trial.score = fit.agreement.correlation;
    trial.evidence = fit.agreement.evidence();
    trial.samples = fit.agreement.samples;
    trial.settled = fit.settled;
    step.evaluations = fit.evaluations;
  } else {
    Watch cancel;  // the caller reports the progress
    cancel.cancel = options.watch.cancel;
    const InformationFit fit =
        fit_information(level, options.mutual_information, trial.corners, cancel);
    trial.corners = fit.corners;
    trial.score = fit.information;
    trial.samples = overlap_of(level, fit.corners).size();
    trial.evidence = static_cast<double>(trial.samples) * fit.information;
    trial.settled = fit.settled;
    step.evaluations = fit.evaluations;
  }
  step.score = trial.score;
  const std::vector<std::size_t> overlap = overlap_of(level, trial.corners);
  if (!overlap.empty())
    step.moved_px = distance_px(before, trial.corners, moments_of(level, overlap));
  trial.steps.push_back(step);
  trial.places.push_back(trial);
}

}  // namespace

void refine(std::vector<Trial>& trials, const BlurLevel& level, RegistrationObjective objective,
            const Effort& effort, const RegistrationOptions& options, const Watch& watch) {
  parallel_for(
      trials.size(), resolve_threads(options.threads),
      [&](std::size_t i, int) { refine_one(trials[i], level, objective, effort, options); }, watch);
}

bool within_limits(const Corners& corners, const BlurLevel& level, const CornerFrame& frame,
                   const RegistrationOptions& options) {
  const AffineParts parts = parts_of(frame.affine(corners));
  const auto fits = [&](double scale) {
    return scale >= options.least_scale / scale_room && scale <= options.largest_scale * scale_room;
  };
  return fits(parts.scale_x) && fits(parts.scale_y) &&
         std::abs(parts.shear) <= options.largest_shear + shear_room &&
         overlap_share(level, corners, overlap_of(level, corners).size()) >=
             overlap_room * options.least_overlap;
}

void prune(std::vector<Trial>& trials, const BlurLevel& level, const CornerFrame& frame,
           const RegistrationOptions& options, double apart_px, std::size_t kept) {
  std::stable_sort(trials.begin(), trials.end(),
                   [](const Trial& a, const Trial& b) { return a.evidence > b.evidence; });
  std::vector<Trial> good;
  std::vector<Moments> moments;
  for (Trial& trial : trials) {
    if (good.size() == kept) break;
    if (!(trial.evidence > 0) || !within_limits(trial.corners, level, frame, options)) continue;
    bool fresh = true;
    for (std::size_t i = 0; i < good.size() && fresh; ++i)
      fresh = distance_px(trial.corners, good[i].corners, moments[i]) >= apart_px;
    if (!fresh) continue;
    moments.push_back(moments_of(level, overlap_of(level, trial.corners)));
    good.push_back(std::move(trial));
  }
  trials = std::move(good);
}

}  // namespace surf
