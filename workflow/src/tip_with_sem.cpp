// SPDX-License-Identifier: GPL-3.0-or-later
#include "tip_with_sem.h"

#include <fmt/format.h>

#include <cmath>

#include "chain_steps.h"
#include "search_places.h"
#include "surf/core/units.h"
#include "surf/reconstruction/tip_search.h"

namespace surf::workflow {
namespace {

constexpr double worth_replacing = 0.995;  // of what the first tip leaves
constexpr int most_rounds = 2;
constexpr double same_place_px = 0.5;

/// Registers again: from the place that was found, or anew if that is not verified.
Pose registered(const PoseOptions& options, const PreparedAfm& afm, const PlacedImage& sem,
                const StoredModel& model, const Affine& found, int threads,
                const Reporter& reporter) {
  PoseOptions from_there = options;
  from_there.landmarks.clear();
  from_there.registration.start = found;
  Pose near = pose_of(from_there, afm, sem, model, threads, reporter);
  if (near.verified() || !options.landmarks.empty()) return near;
  Pose anew = pose_of(options, afm, sem, model, threads, reporter);
  return anew.verified() || anew.registration->score > near.registration->score ? anew : near;
}

}  // namespace

bool find_tip_with_sem(PreparedAfm& afm, Pose& pose, const PoseOptions& options,
                       const PlacedImage& sem, const StoredModel& model, int threads,
                       const Reporter& reporter) {
  begin(reporter, "tip");
  const bool fixed = options.transform || options.landmarks_only;
  if (!fixed) go_to_likeliest_place(pose, options, afm, sem, model, threads, reporter);
  bool replaced = false;
  for (int round = 0; round < most_rounds; ++round) {
    FoundTip found = find_tip_by_sem(afm.image, afm.tip, sem, *model.model, pose.sem_to_afm,
                                     threads, reporter.watch());
    if (!(found.residual < worth_replacing * found.residual_before)) break;
    replaced = true;
    afm.tip = std::move(found.tip);
    afm.tip_round = false;
    afm.tip_from_sem = true;
    afm.notes.push_back(fmt::format(
        "tip found with the SEM image: radius {}, half angle {:.0f} deg, {:.0f} % steeper on one "
        "side",
        format_length(found.radius_nm), found.half_angle_deg, 100 * found.lean));
    reporter.note("AFM: " + afm.notes.back());
    CertaintyOptions certainty;
    certainty.noise_nm = std::sqrt(afm.noise.variance_nm2());
    certainty.threads = threads;
    afm.certainty = certainty_map(afm.image, afm.tip, certainty);
    if (fixed) break;
    const Affine before = pose.sem_to_afm;
    pose = registered(options, afm, sem, model, found.sem_to_afm, threads, reporter);
    if (apart_px(before, pose.sem_to_afm, sem) < same_place_px) break;
  }
  return replaced;
}

}  // namespace surf::workflow
