// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/afm_preparation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "surf/afm/background.h"
#include "surf/afm/height_range.h"
#include "surf/afm/hough_plane.h"
#include "surf/afm/morphology.h"
#include "surf/afm/noise_check.h"
#include "surf/afm/resample.h"
#include "surf/afm/round_tip.h"
#include "surf/afm/substrate_noise.h"
#include "surf/afm/tip_doubt.h"
#include "surf/afm/tip_sweep.h"
#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf::workflow {
namespace {

constexpr double same_pitch = 1e-6;   // relative
constexpr int tip_sizes[] = {5, 7, 9, 11, 13, 19, 27, 39, 57};
constexpr int enough = 9;             // samples that are tried in any case
constexpr double told_share = 0.1;    // of the directions that a round tip goes by
constexpr double told_deviations = 3;  // of noise: a tip no deeper is told by noise alone
constexpr double ground_correlation = 0.5;   // of whitened neighbours in two rows
constexpr double noise_span = 6;      // standard deviations of noise in the range of heights

/// Takes off what the method says; returns what rows should go by.
Grid<unsigned char> level(HeightField& field, const AfmPreparationOptions& o, PreparedAfm& prepared, bool last,
                          const Watch& watch) {
  if (o.level == LevelMethod::none) return {};
  if (o.level == LevelMethod::polynomial) {
    subtract(field, fit_polynomial(field, o.degree));
    if (last) prepared.notes.push_back(fmt::format("levelled by a polynomial of degree {}", o.degree));
    return {};
  }
  if (o.level == LevelMethod::plane) {
    const Plane plane = fit_plane(field);
    if (last) prepared.notes.push_back(fmt::format("levelled by the mean plane, tilt {:.3g} deg", plane.tilt_deg()));
    prepared.tilt_deg = std::max(prepared.tilt_deg, plane.tilt_deg());
    subtract(field, plane);
    return {};
  }
  HoughOptions hough;
  hough.watch = watch;
  HoughSummary s = find_plane(field, hough);
  subtract(field, s.plane);
  prepared.tilt_deg = std::max(prepared.tilt_deg, s.plane.tilt_deg());
  if (!last) return std::move(s.inliers);
  prepared.notes.push_back(fmt::format("levelled by the plane that {:.0f} % of the scan lies on, tilt {:.3g} deg",
                                       100 * s.inlier_share, prepared.tilt_deg));
  if (s.verdict != HoughVerdict::clear)
    prepared.warnings.push_back(fmt::format(
        "the scan was levelled by a plane that {}. Look at it, and level the scan first ('semsurf level') or choose "
        "`reconstruction.level_method`", s.verdict == HoughVerdict::contested ? "has a rival at another height" : "hardly stands out"));
  return std::move(s.inliers);
}

void level_scan(PreparedAfm& prepared, const AfmPreparationOptions& o) {
  Grid<unsigned char> substrate = level(prepared.image, o, prepared, !o.rows, o.watch.part(0, 0.05));
  if (!o.rows) return;
  level_rows(prepared.image, *o.rows, substrate);
  prepared.notes.push_back("steps between scan lines taken off");
  level(prepared.image, o, prepared, true, o.watch.part(0.05, 0.1));
}

/// Noise knows nothing of the row before: where a "substrate" goes on from row to row it is rough ground.
bool is_ground(const SubstrateNoise& found) {
  const Grid<double> white = whiten(found.residual_nm, found.estimate.noise, found.substrate);
  NoiseCheckOptions options;
  options.lags = 1;
  const NoiseCheck check = check_noise(white, found.substrate, options);
  return !check.across.empty() && check.across.front().correlation > ground_correlation;
}

void find_noise(PreparedAfm& prepared, const AfmPreparationOptions& o) {
  if (o.noise) {
    validate(*o.noise, "`reconstruction.afm_noise`");
    prepared.noise = *o.noise;
    return;
  }
  FlatNoiseOptions flat;
  flat.watch = o.watch.part(0.1, 0.15);
  const SubstrateNoise substrate = estimate_substrate_noise(prepared.image, flat);
  const bool clear = substrate.plane.verdict == HoughVerdict::clear && !is_ground(substrate);
  const NoiseEstimate estimate = clear ? substrate.estimate : estimate_noise(prepared.image);
  prepared.noise = estimate.noise;
  prepared.noise_estimate = estimate;
  if (!(prepared.noise.innovation_nm2 > 0))
    throw InvalidInput("AFM scan", "it has no noise that could be estimated: it may be simulated or filtered",
                       "Say `reconstruction.afm_noise=ALPHA,INNOVATION`, as 0.8,0.2nm2");
  prepared.notes.push_back(fmt::format("noise of {}: {} rms, alpha {:.3f}", clear ? "the substrate" : "the differences",
                                       format_length(estimate.sigma_nm()), estimate.noise.alpha));
  if (!clear && estimate.alpha_at_limit)
    prepared.warnings.push_back("the scan's noise can hardly be told from its structure and may be less. Say `reconstruction.afm_noise`, "
                                "from a flat scan: 'semsurf noise'");
  if (const std::string doubt = clear ? "" : doubt_of_noise(prepared.noise, prepared.image); !doubt.empty())
    prepared.warnings.push_back(doubt + ". Say `reconstruction.afm_noise`");
}

/// A tip that was found, and why not to trust it.
void set_doubt(PreparedAfm& prepared, const std::string& doubt) {
  prepared.tip.doubt = doubt;
  if (!doubt.empty())
    prepared.warnings.push_back(fmt::format("the tip that was found in the scan is not to be trusted: {}. Check "
                                            "`reconstruction.level_method`, `reconstruction.rows` and `reconstruction.afm_noise`, or give `reconstruction.tip`", doubt));
}

Tip of_pitch(const Tip& tip, const HeightField& image) {
  const auto differ = [](double a, double b) { return std::abs(a - b) > same_pitch * std::max(a, b); };
  if (differ(tip.pitch_x_nm, image.pitch_x_nm) || differ(tip.pitch_y_nm, image.pitch_y_nm))
    return resampled(tip, image.pitch_x_nm, image.pitch_y_nm);
  Tip same = tip;   // but for what a file's text rounds
  same.pitch_x_nm = image.pitch_x_nm, same.pitch_y_nm = image.pitch_y_nm;
  return same;
}

BlindTipOptions blind_options(int size, int threads) {
  BlindTipOptions blind;
  blind.width = blind.height = size;
  blind.threads = threads;
  return blind;
}

TipSweep swept(const HeightField& image, const AfmNoise& noise, int size, const AfmPreparationOptions& o, const Watch& watch) {
  TipSweepOptions sweep;
  sweep.blind = blind_options(size, o.threads);
  sweep.noise = noise;
  sweep.seed = o.seed;
  TipSweep found = sweep_tips({image}, sweep, watch.progress, watch.cancel);
  if (found.verdict == TipSweepVerdict::cancelled) throw Interrupted();
  return found;
}

void find_free_tip(PreparedAfm& prepared, const AfmPreparationOptions& o, const Watch& watch) {
  TipSweep found = swept(prepared.image, prepared.noise, o.tip_size, o, watch);
  const std::string doubt = doubt_of_tip(found);
  SweptTip& chosen = found.curve[found.chosen];
  prepared.tip_threshold_nm = chosen.threshold_nm;
  prepared.tip = std::move(chosen.tip);
  prepared.notes.push_back(fmt::format("tip of {} x {} samples, found blindly at a threshold of {}", o.tip_size, o.tip_size,
                                       format_length(prepared.tip_threshold_nm)));
  set_doubt(prepared, doubt);
  if (found.verdict == TipSweepVerdict::disagreement)
    prepared.warnings.push_back("two ways to choose the tip's threshold disagree: look at 'semsurf tip --plot', and give "
                                "`reconstruction.tip` if you know it better");
  const auto open = unconstrained_directions(prepared.tip, prepared.tip_threshold_nm +
                                                               3 * std::sqrt(prepared.noise.variance_nm2()));
  if (!open.empty())
    prepared.warnings.push_back(fmt::format("the scan does not tell the tip's shape in {} of 36 directions: there it is "
                                            "taken as the bluntest possible, and walls as steep as they can be", open.size()));
}

void find_round_tip(PreparedAfm& prepared, const AfmPreparationOptions& o, const Watch& watch) {
  const HeightField& image = prepared.image;
  const int shorter = std::min(image.z_nm.width(), image.z_nm.height());
  const double relief = height_range({&image, 1}).span_nm() - noise_span * std::sqrt(prepared.noise.variance_nm2());
  if (!(relief > 0))
    throw InvalidInput("AFM scan", "its relief is no higher than its noise, so it tells nothing of the tip",
                       "Give `reconstruction.tip`, or another scan");
  std::vector<std::vector<double>> told;
  int widest = 0;
  std::string doubt;   // none where the sweep of any size has none
  constexpr auto sizes = static_cast<double>(std::size(tip_sizes));
  for (std::size_t i = 0; i < std::size(tip_sizes); ++i) {
    const int size = tip_sizes[i];
    if (size > (told.empty() ? shorter : shorter / 3)) break;
    const TipSweep found = swept(image, prepared.noise, size, o, watch.part(double(i) / sizes, double(i + 1) / sizes));
    const SweptTip& chosen = found.curve[found.chosen];
    if (told.empty() || !doubt.empty()) doubt = doubt_of_sweep(found);
    widest = size;
    prepared.tip_threshold_nm = chosen.threshold_nm;
    told.push_back(round_profile_nm(chosen.tip, told_share));
    prepared.tip = tip_below(told, image.pitch_x_nm, image.pitch_y_nm, relief, shorter / 2);
    if (size >= enough && std::max(prepared.tip.z_nm.width(), prepared.tip.z_nm.height()) <= size + 2) break;
  }
  if (told.empty())
    throw InvalidInput("AFM scan", fmt::format("it has {} x {} samples, too few to find a tip in", image.z_nm.width(),
                                               image.z_nm.height()), "Give `reconstruction.tip`");
  prepared.tip_round = true;
  const double noise = told_deviations * std::sqrt(prepared.noise.variance_nm2());
  if (std::ranges::none_of(told, [&](const auto& profile) { return profile.back() < -noise; })) {
    prepared.tip = {Grid<double>(1, 1), image.pitch_x_nm, image.pitch_y_nm, 0, 0};
    prepared.warnings.push_back("the scan tells nothing of its tip, which is taken as sharp, so that the scan is the surface. "
                                "Give `reconstruction.tip` if you know it");
    return;
  }
  set_doubt(prepared, doubt);
  prepared.notes.push_back(fmt::format("round tip of {} x {} samples, from what blind ones of up to {} samples tell",
                                       prepared.tip.z_nm.width(), prepared.tip.z_nm.height(), widest));
}

void find_tip(PreparedAfm& prepared, const AfmPreparationOptions& o) {
  const Watch watch = o.watch.part(0.15, 0.95);
  if (o.tip) {
    validate(*o.tip, "`reconstruction.tip`");
    prepared.tip = of_pitch(*o.tip, prepared.image);
    if (!o.tip->doubt.empty())
      prepared.warnings.push_back(fmt::format("the tip's file says that it is not to be trusted: {}", o.tip->doubt));
    prepared.tip_given = true;
  } else if (o.tip_size) {
    find_free_tip(prepared, o, watch);
  } else {
    find_round_tip(prepared, o, watch);
  }
}

}  // namespace

PreparedAfm prepare_afm(const HeightField& scan, const AfmPreparationOptions& o) {
  validate(scan, "AFM scan");
  if (o.tip_size != 0 && (o.tip_size < 3 || o.tip_size % 2 == 0))
    throw UsageError("`reconstruction.tip_size`", fmt::format("{} samples have no middle for the apex", o.tip_size), "Give an odd number from 3 on");
  const int shorter = std::min(scan.z_nm.width(), scan.z_nm.height());
  if (o.tip_size > shorter)
    throw UsageError("`reconstruction.tip_size`", fmt::format("{} samples, but the scan has {} x {}", o.tip_size, scan.z_nm.width(),
                                               scan.z_nm.height()), fmt::format("Give {} at most", shorter - (shorter % 2 == 0)));
  if (!(height_range({&scan, 1}).span_nm() > 0))
    throw InvalidInput("AFM scan", "all its heights are the same", "Choose the channel of heights with `reconstruction.afm_channel`");
  PreparedAfm prepared;
  prepared.image = scan;
  level_scan(prepared, o);
  find_noise(prepared, o);
  find_tip(prepared, o);
  if (prepared.tip.z_nm.width() > scan.z_nm.width() || prepared.tip.z_nm.height() > scan.z_nm.height())
    throw InvalidInput("`reconstruction.tip`", fmt::format("it is {} x {} samples, wider than the scan of {} x {}",
                                            prepared.tip.z_nm.width(), prepared.tip.z_nm.height(), scan.z_nm.width(),
                                            scan.z_nm.height()), "Crop the tip to what can touch the surface, or check its pixel size");
  CertaintyOptions certainty;
  certainty.noise_nm = std::sqrt(prepared.noise.variance_nm2());
  certainty.threads = o.threads;
  certainty.watch = o.watch.part(0.95, 1);
  prepared.certainty = certainty_map(prepared.image, prepared.tip, certainty);
  return prepared;
}

}  // namespace surf::workflow
