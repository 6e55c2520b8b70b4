// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/afm_preparation.h"

#include <fmt/format.h>

#include <algorithm>

#include "surf/afm/background.h"
#include "surf/afm/height_range.h"
#include "surf/afm/hough_plane.h"
#include "surf/afm/morphology.h"
#include "surf/afm/round_tip_search.h"
#include "surf/afm/substrate_noise.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/workflow/morphology_job.h"
#include "surf/workflow/tip_job.h"

namespace surf::workflow {
namespace {

/// A reporter that stores the messages of a step.
Reporter keeping(PreparedAfm& prepared, const Watch& watch) {
  Reporter reporter;
  reporter.on_progress = [watch](double done, double total, std::string_view) {
    if (watch.progress) watch.progress(done, total);
  };
  reporter.on_note = [&prepared](const std::string& text) { prepared.notes.push_back(text); };
  reporter.on_warning = [&prepared](const std::string& text) { prepared.warnings.push_back(text); };
  reporter.cancel = watch.cancel;
  return reporter;
}

/// Rough ground has no plane of its own, and the best of several may be any.
void find_level_doubt(PreparedAfm& prepared, const Mask& substrate) {
  if (prepared.tilt_deg > 0)
    prepared.level_doubt =
        doubt_of_plane(prepared.image, prepared.rough_ground ? Mask() : substrate);
}

Mask level_scan(PreparedAfm& prepared, const HeightField& scan, const AfmPreparationOptions& o) {
  LevelResult levelled = level(scan, o.level, {}, keeping(prepared, o.watch.part(0, 0.1)));
  prepared.tilt_deg = levelled.tilt_deg;
  if (levelled.rows) prepared.notes.push_back("steps between scan lines taken off");
  if (o.level.method == LevelMethod::polynomial)
    prepared.notes.push_back(fmt::format("levelled by a polynomial of degree {}", o.level.degree));
  if (o.level.method == LevelMethod::plane)
    prepared.notes.push_back(
        fmt::format("levelled by the mean plane, tilt {:.3g} deg", levelled.plane->tilt_deg()));
  if (levelled.hough)
    prepared.notes.push_back(
        fmt::format("levelled by the plane that {:.0f} % of the scan lies on, tilt {:.3g} deg",
                    100 * levelled.hough->inlier_share, prepared.tilt_deg));
  prepared.image = std::move(levelled.field);
  return levelled.substrate;
}

/// The substrate, which also says whether there are plateaus. A scan whose noise is given need have
/// none.
std::optional<SubstrateNoise> find_substrate(PreparedAfm& prepared,
                                             const AfmPreparationOptions& o) {
  FlatNoiseOptions flat;
  flat.watch = o.watch.part(0.1, 0.15);
  try {
    SubstrateNoise found = estimate_substrate_noise(prepared.image, flat);
    prepared.rough_ground = found.plane.verdict == HoughVerdict::weak || is_rough_ground(found);
    return found;
  } catch (const InvalidInput&) {
    if (!o.noise) throw;
    return {};
  }
}

void find_noise(PreparedAfm& prepared, const AfmPreparationOptions& o) {
  const std::optional<SubstrateNoise> found = find_substrate(prepared, o);
  if (o.noise) {
    validate(*o.noise, "`scan.height_noise`");
    prepared.noise = *o.noise;
    return;
  }
  const SubstrateNoise& substrate = *found;
  const bool clear = substrate.plane.verdict == HoughVerdict::clear && !is_rough_ground(substrate);
  const NoiseEstimate estimate = clear ? substrate.estimate : estimate_noise(prepared.image);
  prepared.noise = estimate.noise;
  prepared.noise_estimate = estimate;
  if (!(prepared.noise.innovation_nm2 > 0))
    throw InvalidInput("AFM scan",
                       "it has no noise that could be estimated: it may be simulated or filtered",
                       "Say `scan.height_noise=SIGMA,ALPHA`, as 0.5nm,0.8");
  prepared.notes.push_back(fmt::format("noise of {}: {} rms, alpha {:.3f}",
                                       clear ? "the substrate" : "the differences",
                                       format_length(estimate.sigma_nm()), estimate.noise.alpha));
  if (!clear)
    tell_noise_doubts(prepared.noise, estimate.alpha_at_limit, prepared.image,
                      keeping(prepared, {}));
}

void find_free_tip(PreparedAfm& prepared, const AfmPreparationOptions& o, const Watch& watch) {
  TipParameters parameters;
  parameters.answer = TipAnswer::sweep;
  parameters.size = o.tip_size;
  parameters.noise = prepared.noise;
  parameters.seed = o.seed;
  parameters.threads = o.threads;
  TipResult found = find_tip({prepared.image}, parameters, keeping(prepared, watch));
  prepared.tip_threshold_nm = *found.used.threshold_nm;
  prepared.tip = std::move(found.tip);
  prepared.notes.push_back(fmt::format("tip of {} x {} samples, found blindly at a threshold of {}",
                                       o.tip_size, o.tip_size,
                                       format_length(prepared.tip_threshold_nm)));
}

void search_round_tip(PreparedAfm& prepared, const AfmPreparationOptions& o, const Watch& watch) {
  RoundTip found = find_round_tip(
      prepared.image,
      {.noise = prepared.noise, .seed = o.seed, .threads = o.threads, .watch = watch});
  prepared.tip = std::move(found.tip);
  prepared.tip_bound = std::move(found.bound);
  prepared.tip_threshold_nm = found.summary.threshold_nm;
  prepared.tip_round = true;
  if (!found.summary.bounded) {
    prepared.tip_warnings.push_back(
        "the scan tells nothing of its tip, which is taken as sharp, so that the scan is the "
        "surface. Give `reconstruction.tip` if you know it");
    return;
  }
  Reporter told = keeping(prepared, watch);
  told.on_warning = [&prepared](const std::string& text) { prepared.tip_warnings.push_back(text); };
  tell_tip_doubt(prepared.tip, told);
  prepared.notes.push_back(
      fmt::format("round tip of {} x {} samples, from what blind ones of up to {} samples tell",
                  prepared.tip.z_nm.width(), prepared.tip.z_nm.height(), found.summary.widest));
}

Tip meeting(const Tip& tip, PreparedAfm& prepared) {
  Reporter reporter = keeping(prepared, {});
  reporter.on_note = nullptr;  // the only note is about a different pitch
  Tip met = tip_for(tip, prepared.image, "tip", reporter);
  met.pitch() = prepared.image.pitch();  // removes rounding errors of a text file
  return met;
}

void choose_tip(PreparedAfm& prepared, const AfmPreparationOptions& o) {
  const Watch watch = o.watch.part(0.15, 0.95);
  if (o.tip) {
    validate(*o.tip, "`reconstruction.tip`");
    prepared.tip = meeting(*o.tip, prepared);
    prepared.tip_given = true;
  } else if (o.tip_size) {
    find_free_tip(prepared, o, watch);
  } else {
    search_round_tip(prepared, o, watch);
  }
}

}  // namespace

PreparedAfm prepare_afm(const HeightField& scan, const AfmPreparationOptions& o) {
  validate(scan, "AFM scan");
  if (o.tip_size != 0 && (o.tip_size < 3 || o.tip_size % 2 == 0))
    throw UsageError("`reconstruction.tip_size`",
                     fmt::format("{} samples have no middle for the apex", o.tip_size),
                     "Give an odd number from 3 on");
  const int shorter = std::min(scan.z_nm.width(), scan.z_nm.height());
  if (o.tip_size > shorter)
    throw UsageError("`reconstruction.tip_size`",
                     fmt::format("{} samples, but the scan has {} x {}", o.tip_size,
                                 scan.z_nm.width(), scan.z_nm.height()),
                     fmt::format("Give {} at most", shorter - (shorter % 2 == 0)));
  if (!(height_range({&scan, 1}).span_nm() > 0))
    throw InvalidInput("AFM scan", "all its heights are the same",
                       "Choose the channel of heights with `scan.height_channel`");
  PreparedAfm prepared;
  const Mask substrate = level_scan(prepared, scan, o);
  find_noise(prepared, o);
  find_level_doubt(prepared, substrate);
  choose_tip(prepared, o);
  if (prepared.tip.z_nm.width() > scan.z_nm.width() ||
      prepared.tip.z_nm.height() > scan.z_nm.height())
    throw InvalidInput("`reconstruction.tip`",
                       fmt::format("it is {} x {} samples, wider than the scan of {} x {}",
                                   prepared.tip.z_nm.width(), prepared.tip.z_nm.height(),
                                   scan.z_nm.width(), scan.z_nm.height()),
                       "Crop the tip to what can touch the surface, or check its pixel size");
  CertaintyOptions certainty;
  certainty.noise_nm = std::sqrt(prepared.noise.variance_nm2());
  certainty.threads = o.threads;
  certainty.watch = o.watch.part(0.95, 1);
  prepared.certainty = certainty_map(prepared.image, prepared.tip, certainty);
  return prepared;
}

}  // namespace surf::workflow
