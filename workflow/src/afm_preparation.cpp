// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/afm_preparation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "surf/afm/background.h"
#include "surf/afm/height_range.h"
#include "surf/afm/hough_plane.h"
#include "surf/afm/morphology.h"
#include "surf/afm/resample.h"
#include "surf/afm/substrate_noise.h"
#include "surf/afm/tip_sweep.h"
#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf::workflow {
namespace {

constexpr double same_pitch = 1e-6;   // relative
constexpr int tip_sizes[] = {9, 13, 19, 27, 39, 57};

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
        "--level-method", s.verdict == HoughVerdict::contested ? "has a rival at another height" : "hardly stands out"));
  return std::move(s.inliers);
}

void level_scan(PreparedAfm& prepared, const AfmPreparationOptions& o) {
  Grid<unsigned char> substrate = level(prepared.image, o, prepared, !o.rows, o.watch.part(0, 0.05));
  if (!o.rows) return;
  level_rows(prepared.image, *o.rows, substrate);
  prepared.notes.push_back("steps between scan lines taken off");
  level(prepared.image, o, prepared, true, o.watch.part(0.05, 0.1));
}

void find_noise(PreparedAfm& prepared, const AfmPreparationOptions& o) {
  if (o.noise) {
    validate(*o.noise, "--afm-noise");
    prepared.noise = *o.noise;
    return;
  }
  FlatNoiseOptions flat;
  flat.watch = o.watch.part(0.1, 0.15);
  const SubstrateNoise substrate = estimate_substrate_noise(prepared.image, flat);
  const bool clear = substrate.plane.verdict == HoughVerdict::clear;
  const NoiseEstimate estimate = clear ? substrate.estimate : estimate_noise(prepared.image);
  prepared.noise = estimate.noise;
  prepared.noise_estimate = estimate;
  if (!(prepared.noise.innovation_nm2 > 0))
    throw InvalidInput("AFM scan", "it has no noise that could be estimated: it may be simulated or filtered",
                       "Say --afm-noise ALPHA,INNOVATION, as 0.8,0.2nm2");
  prepared.notes.push_back(fmt::format("noise of {}: {} rms, alpha {:.3f}", clear ? "the substrate" : "the differences",
                                       format_length(estimate.sigma_nm()), estimate.noise.alpha));
  if (!clear && estimate.alpha_at_limit)
    prepared.warnings.push_back("the scan's noise can hardly be told from its structure and may be less. Say --afm-noise, "
                                "from a flat scan: 'semsurf noise'");
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

void find_tip(PreparedAfm& prepared, const AfmPreparationOptions& o) {
  if (o.tip) {
    validate(*o.tip, "--tip");
    prepared.tip = of_pitch(*o.tip, prepared.image);
    prepared.tip_given = true;
    return;
  }
  const int size = o.tip_size ? o.tip_size
                              : choose_tip_size(prepared.image, prepared.noise, o.threads, o.watch.part(0.15, 0.3));
  TipSweepOptions sweep;
  sweep.blind = blind_options(size, o.threads);
  sweep.noise = prepared.noise;
  sweep.seed = o.seed;
  const Watch watch = o.watch.part(0.3, 0.95);
  TipSweep found = sweep_tips({prepared.image}, sweep, watch.progress, watch.cancel);
  if (found.verdict == TipSweepVerdict::cancelled) throw Interrupted();
  SweptTip& chosen = found.curve[found.chosen];
  prepared.tip_threshold_nm = chosen.threshold_nm;
  prepared.tip = std::move(chosen.tip);
  prepared.notes.push_back(fmt::format("tip of {} x {} samples, found blindly at a threshold of {}", size, size,
                                       format_length(prepared.tip_threshold_nm)));
  if (found.verdict == TipSweepVerdict::none)
    prepared.warnings.push_back(fmt::format("no tip explains the scan: {:.1f} times what the noise leaves is left at best. "
                                            "Check --level-method, --rows and --afm-noise, or give --tip", chosen.excess()));
  if (found.verdict == TipSweepVerdict::disagreement)
    prepared.warnings.push_back("two ways to choose the tip's threshold disagree: look at 'semsurf tip --plot', and give "
                                "--tip if you know it better");
  const auto open = unconstrained_directions(prepared.tip, prepared.tip_threshold_nm +
                                                               3 * std::sqrt(prepared.noise.variance_nm2()));
  if (!open.empty())
    prepared.warnings.push_back(fmt::format("the scan does not tell the tip's shape in {} of 36 directions: there it is "
                                            "taken as the bluntest possible, and walls as steep as they can be", open.size()));
}

}  // namespace

int choose_tip_size(const HeightField& image, const AfmNoise& noise, int threads, const Watch& watch) {
  const double tolerance = 0.5 * std::sqrt(noise.variance_nm2());
  const int most = std::max(3, std::min(image.z_nm.width(), image.z_nm.height()) / 3);
  HeightField before;
  int size = 0;
  for (const int next : tip_sizes) {
    if (next > most) break;
    watch.report(next, tip_sizes[std::size(tip_sizes) - 1]);
    BlindTipOptions blind = blind_options(next, threads);
    blind.maxima_only = true;
    blind.threshold_nm = blind.apex_tolerance_nm =
        outer_threshold_nm(noise, static_cast<double>(image.z_nm.size()), double(next) * next);
    BlindTipSummary summary;
    const Tip tip = blind_tip({image}, blind, summary, {}, watch.cancel);
    watch.check();
    MorphologyOptions morphology;
    morphology.threads = threads;
    HeightField eroded = erode(image, tip, morphology);
    if (size > 0) {
      double sum = 0;
      for (std::size_t i = 0; i < eroded.z_nm.size(); ++i)
        if (eroded.valid.empty() || eroded.valid.data()[i])
          sum += std::pow(eroded.z_nm.data()[i] - before.z_nm.data()[i], 2);
      if (std::sqrt(sum / static_cast<double>(eroded.z_nm.size())) < tolerance) return size;
    }
    before = std::move(eroded);
    size = next;
  }
  return size > 0 ? size : most - (most % 2 == 0);
}

PreparedAfm prepare_afm(const HeightField& scan, const AfmPreparationOptions& o) {
  validate(scan, "AFM scan");
  if (o.tip_size != 0 && (o.tip_size < 3 || o.tip_size % 2 == 0))
    throw UsageError("--tip-size", fmt::format("{} samples have no middle for the apex", o.tip_size), "Give an odd number from 3 on");
  const int shorter = std::min(scan.z_nm.width(), scan.z_nm.height());
  if (o.tip_size > shorter)
    throw UsageError("--tip-size", fmt::format("{} samples, but the scan has {} x {}", o.tip_size, scan.z_nm.width(),
                                               scan.z_nm.height()), fmt::format("Give {} at most", shorter - (shorter % 2 == 0)));
  if (!(height_range({&scan, 1}).span_nm() > 0))
    throw InvalidInput("AFM scan", "all its heights are the same", "Choose the channel of heights with --afm-channel");
  PreparedAfm prepared;
  prepared.image = scan;
  level_scan(prepared, o);
  find_noise(prepared, o);
  find_tip(prepared, o);
  if (prepared.tip.z_nm.width() > scan.z_nm.width() || prepared.tip.z_nm.height() > scan.z_nm.height())
    throw InvalidInput("--tip", fmt::format("it is {} x {} samples, wider than the scan of {} x {}",
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
