// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/tip_doubt.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "surf/afm/certainty.h"
#include "surf/afm/roughness.h"
#include "surf/afm/tip_measure.h"
#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf {
namespace {

constexpr double widest_radius = 100;  // in widths of the tip
constexpr double most_noise = 0.5;     // of the scan's variance

/// Thresholds make the end of a blind tip flat where it falls by less than the threshold. All
/// samples are fitted then.
TipMeasures measure_whole_tip(const Tip& tip) {
  const TipMeasures end = measure_tip(tip);
  double depth_nm = 0;
  for (const double z : tip.z_nm.data())
    if (std::isfinite(z)) depth_nm = std::max(depth_nm, -z);
  if ((std::isfinite(end.radius_nm) && end.radius_nm > 0) || !(depth_nm > 0)) return end;
  return measure_tip(tip, {.fit_depth_nm = depth_nm});
}

std::string joined(const std::string& a, const std::string& b) {
  return a + (a.empty() || b.empty() ? "" : "; ") + b;
}

}  // namespace

std::string doubt_of_sweep(const TipSweep& sweep) {
  const SweptTip& chosen = sweep.curve.at(sweep.chosen);
  std::string doubt;
  if (sweep.verdict == TipSweepVerdict::none)
    doubt =
        fmt::format("no tip explains the scan: {:.1f} times what the noise leaves is left at best",
                    chosen.excess());
  if (sweep.curve.size() > 1 && sweep.chosen + 1 == sweep.curve.size())
    doubt = joined(
        doubt,
        fmt::format("its threshold of {} is the largest that was tried, so that none is told",
                    format_length(chosen.threshold_nm)));
  return doubt;
}

std::string doubt_of_shape(const Tip& tip) {
  const double width_nm =
      std::max(tip.z_nm.width() * tip.pitch_x_nm, tip.z_nm.height() * tip.pitch_y_nm);
  double radius_nm = 0;
  try {
    radius_nm = measure_whole_tip(tip).radius_nm;
  } catch (const InvalidInput&) {
    return {};  // too few samples
  }
  if (!std::isfinite(radius_nm)) return "it is flat, so that the scan tells nothing of its radius";
  if (radius_nm <= 0) return "it is hollow, as no tip is";
  if (radius_nm <= widest_radius * width_nm) return {};
  return fmt::format("its radius of {} is that of a plane over its width of {}",
                     format_length(radius_nm), format_length(width_nm));
}

std::string doubt_of_tip(const TipSweep& sweep) {
  return joined(doubt_of_sweep(sweep), doubt_of_shape(sweep.curve.at(sweep.chosen).tip));
}

std::string doubt_of_noise(const AfmNoise& noise, const HeightField& scan) {
  const double sigma_nm = std::sqrt(noise.variance_nm2()),
               sq_nm = measure_roughness(scan).sq_levelled_nm;
  if (!(noise.variance_nm2() > most_noise * sq_nm * sq_nm)) return {};
  return fmt::format(
      "the noise of {}, from differences of neighbouring rows and columns, is most of the scan's "
      "roughness "
      "(Sq {}), and rough ground is taken for noise there; the second differences of single pixels "
      "give {}",
      format_length(sigma_nm), format_length(sq_nm), format_length(pixel_noise_nm(scan)));
}

}  // namespace surf
