// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/round_tip_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "surf/afm/height_range.h"
#include "surf/afm/round_tip.h"
#include "surf/afm/tip_doubt.h"
#include "surf/afm/tip_sweep.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr int tip_sizes[] = {5, 7, 9, 11, 13, 19, 27, 39, 57};
constexpr int enough = 9;               // tips up to this size are always tried
constexpr double bounding_share = 0.1;  // share of the directions that bound a round tip
constexpr double noise_deviations = 3;  // a shallower tip is explained by noise
constexpr double noise_span = 6;        // range of heights due to noise, in its standard deviations

TipSweep sweep_of(const HeightField& scan, int size, const RoundTipOptions& o, const Watch& watch) {
  TipSweepOptions sweep;
  sweep.blind.width = sweep.blind.height = size;
  sweep.blind.threads = o.threads;
  sweep.noise = o.noise;
  sweep.seed = o.seed;
  sweep.watch = watch;
  return sweep_tips({scan}, sweep);
}

}  // namespace

RoundTip find_round_tip(const HeightField& scan, const RoundTipOptions& o) {
  const int shorter = std::min(scan.z_nm.width(), scan.z_nm.height());
  const double relief =
      height_range({&scan, 1}).span_nm() - noise_span * std::sqrt(o.noise.variance_nm2());
  if (!(relief > 0))
    throw InvalidInput("AFM scan",
                       "its relief is no higher than its noise, so it tells nothing of the tip",
                       "Give the tip, or another scan");
  RoundTip out;
  std::vector<std::vector<double>> profiles;
  std::string doubt;
  constexpr auto sizes = static_cast<double>(std::size(tip_sizes));
  for (std::size_t i = 0; i < std::size(tip_sizes); ++i) {
    const int size = tip_sizes[i];
    if (size > (profiles.empty() ? shorter : shorter / 3)) break;
    const TipSweep found =
        sweep_of(scan, size, o, o.watch.part(double(i) / sizes, double(i + 1) / sizes));
    const SweptTip& chosen = found.curve[found.chosen];
    if (profiles.empty() || !doubt.empty()) doubt = doubt_of_sweep(found);
    out.summary.widest = size;
    out.summary.threshold_nm = chosen.threshold_nm;
    profiles.push_back(round_profile_nm(chosen.tip, bounding_share));
    out.bound = chosen.tip;
    out.tip = tip_below(profiles, scan.pitch_x_nm, scan.pitch_y_nm, relief, shorter / 2);
    if (size >= enough && std::max(out.tip.z_nm.width(), out.tip.z_nm.height()) <= size + 2) break;
  }
  if (profiles.empty())
    throw InvalidInput("AFM scan",
                       fmt::format("it has {} x {} samples, too few to find a tip in",
                                   scan.z_nm.width(), scan.z_nm.height()),
                       "Give the tip");
  const double noise = noise_deviations * std::sqrt(o.noise.variance_nm2());
  out.summary.bounded =
      std::ranges::any_of(profiles, [&](const auto& profile) { return profile.back() < -noise; });
  if (out.summary.bounded) out.tip.doubt = doubt;
  else out.tip = {scan.pitch(), Grid<double>(1, 1), 0, 0};
  return out;
}

}  // namespace surf
