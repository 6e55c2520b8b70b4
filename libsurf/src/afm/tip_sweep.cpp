// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/tip_sweep.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "explained.h"
#include "surf/afm/height_range.h"
#include "surf/afm/tip_measure.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"

namespace surf {

namespace {

constexpr double peak_share = 1e-3;  // share of the residuals that are peaks
constexpr double as_near = 1.1;      // consistent: at most this times the least excess
constexpr double too_much = 6;       // no tip explains the scans if the least excess is larger
constexpr double smooths = 0.6;      // least share of the largest expected residual
// Distance between choice and jump that counts as near, as a share of the thresholds.
constexpr double near_jump = 0.1;

void check(const TipSweepOptions& o) {
  validate(o.noise);
  if (!(o.least_nm >= 0 && o.most_nm >= o.least_nm && std::isfinite(o.most_nm)) ||
      (o.most_nm > 0 && o.most_nm == o.least_nm))
    throw UsageError("thresholds",
                     fmt::format("{:g} to {:g} nm is no range", o.least_nm, o.most_nm),
                     "Give the smaller first");
  if (o.thresholds < 2 || o.thresholds > 10000)
    throw UsageError("thresholds", "their number must be 2 to 10000", "Ask for 40");
  if (!(o.tolerance_per_threshold >= 0 && std::isfinite(o.tolerance_per_threshold)))
    throw UsageError("apex tolerance", "it must be 0 or more", "Give 1 times the threshold");
  if (o.draws < 2 || o.draws > 1000)
    throw UsageError("draws", "their number must be 2 to 1000", "Ask for 3");
}

CarvedTip carved(const Tip& tip) {
  CarvedTip out;
  out.width = tip.z_nm.width();
  out.height = tip.z_nm.height();
  out.apex_x = tip.apex_x;
  out.apex_y = tip.apex_y;
  out.stride = (out.width + 15) / 16 * 16;
  const auto count = static_cast<std::size_t>(out.stride * out.height);
  out.z.assign(count, -HUGE_VALF);
  out.threshold.assign(count, 0);
  for (int j = 0; j < out.height; ++j)
    for (int i = 0; i < out.width; ++i)
      out.z[static_cast<std::size_t>(j * out.stride + i)] = static_cast<float>(tip.z_nm(i, j));
  return out;
}

// Residuals of all scans together.
struct Residuals {
  double rms = 0, peaks = 0;
};

Residuals summary_of(std::vector<float>& all) {
  Residuals out;
  if (all.empty()) return out;
  double squares = 0;
  for (const float r : all) squares += static_cast<double>(r) * r;
  out.rms = std::sqrt(squares / static_cast<double>(all.size()));
  const auto few = std::max<std::size_t>(
      1, static_cast<std::size_t>(peak_share * static_cast<double>(all.size())));
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(few - 1), all.end(),
                   std::greater<>());
  for (std::size_t k = 0; k < few; ++k) out.peaks += all[k] / static_cast<double>(few);
  return out;
}

class Opener {
 public:
  Opener(const std::vector<HeightField>& scans, const TipSweepOptions& o)
      : options_(o), threads_(resolve_threads(o.blind.threads)) {
    const HeightRange range = height_range(scans);
    range_nm_ = range.span_nm();
    for (const HeightField& s : scans) {
      Grid<float>& z = heights_.emplace_back(s.z_nm.width(), s.z_nm.height(), NAN);
      for (int y = 0; y < z.height(); ++y)
        for (int x = 0; x < z.width(); ++x)
          if (s.is_valid(x, y)) z(x, y) = static_cast<float>(s.z_nm(x, y) - range.low_nm);
    }
    for (int d = 0; d < o.draws; ++d)
      for (std::size_t s = 0; s < heights_.size(); ++s)
        noise_.push_back(
            simulate_noise(o.noise, heights_[s].width(), heights_[s].height(),
                           o.seed + static_cast<std::uint64_t>(d) * heights_.size() + s));
  }

  double range_nm() const { return range_nm_; }

  void judge(SweptTip& swept) const {
    const CarvedTip tip = carved(swept.tip);
    std::vector<Grid<float>> opened;
    std::vector<float> left;
    for (const Grid<float>& z : heights_) opened.push_back(open(z, tip, left));
    const Residuals seen = summary_of(left);
    const double n = options_.draws;
    for (int d = 0; d < options_.draws; ++d) {
      left.clear();
      for (std::size_t s = 0; s < opened.size(); ++s) {
        Grid<float> noisy = opened[s];
        const Grid<double>& e = noise_[static_cast<std::size_t>(d) * opened.size() + s];
        for (std::size_t k = 0; k < noisy.size(); ++k)
          noisy.data()[k] += static_cast<float>(e.data()[k]);
        open(noisy, tip, left);
      }
      const Residuals r = summary_of(left);
      swept.expected_nm += r.rms / n;
      swept.expected_peaks_nm += r.peaks / n;
    }
    swept.residual_nm = seen.rms;
    swept.peaks_nm = seen.peaks;
  }

 private:
  // Opens `z`; NaN where the opening is not known. Appends the remaining heights to `left`.
  Grid<float> open(const Grid<float>& z, const CarvedTip& tip, std::vector<float>& left) const {
    const CarvedScan scan(z, 0, tip.width, tip.height);
    Grid<float> out = explained_height(scan, apex_heights(scan, tip, threads_), tip, threads_);
    for (std::size_t k = 0; k < out.size(); ++k) {
      float& made = out.data()[k];
      if (!std::isfinite(made) || !std::isfinite(z.data()[k])) made = NAN;
      else left.push_back(z.data()[k] - made);
    }
    return out;
  }

  const TipSweepOptions& options_;
  int threads_;
  double range_nm_ = 0;
  std::vector<Grid<float>> heights_;
  std::vector<Grid<double>> noise_;  // draw by draw, scan by scan
};

// The index of the broader of the two tips between which the volume falls by the largest factor.
std::size_t above_the_jump(const std::vector<SweptTip>& curve) {
  std::size_t jump = curve.size() - 1;
  double largest = 0;
  for (std::size_t k = 1; k < curve.size(); ++k) {
    const double ratio = curve[k].volume_nm3 > 0 && curve[k - 1].volume_nm3 > 0
                             ? std::log(curve[k - 1].volume_nm3 / curve[k].volume_nm3)
                             : 0;
    if (std::fabs(ratio) > largest) {
      largest = std::fabs(ratio);
      jump = k;
    }
  }
  return jump;
}

// The x that a standard normal number exceeds with probability p < 0.5 (bisection of erfc).
double normal_quantile_above(double p) {
  double low = 0, high = 40;
  for (int n = 0; n < 80; ++n) {
    const double x = 0.5 * (low + high);
    (0.5 * std::erfc(x / std::numbers::sqrt2) > p ? low : high) = x;
  }
  return high;
}

}  // namespace

double SweptTip::excess() const {
  if (residual_nm == 0) return 0;
  if (!(expected_nm > 0)) return HUGE_VAL;
  return std::max(residual_nm / expected_nm, peaks_nm / expected_peaks_nm);
}

TipSweep sweep_tips(const std::vector<HeightField>& scans, const TipSweepOptions& options) {
  check(options);
  const double sigma = std::sqrt(options.noise.variance_nm2());
  const bool given = options.most_nm > 0;
  const double least = given ? options.least_nm : 0.3 * sigma,
               most = given ? options.most_nm : 8 * sigma;
  BlindTipOptions blind = options.blind;
  blind.threshold_y_nm.reset();
  blind.watch = {{}, options.watch.cancel};
  TipSweep out;
  const Opener opener(scans, options);
  for (int n = options.thresholds - 1; n >= 0;
       // Each threshold starts from the tip of the threshold above it.
       --n) {
    SweptTip swept;
    swept.threshold_nm = least + (most - least) * n / (options.thresholds - 1);
    blind.threshold_nm = swept.threshold_nm;
    blind.apex_tolerance_nm = options.tolerance_per_threshold * swept.threshold_nm;
    swept.tip = blind_tip(scans, blind).tip;
    swept.volume_nm3 = tip_volume_nm3(swept.tip, opener.range_nm());
    opener.judge(swept);
    blind.start = swept.tip;
    out.curve.push_back(std::move(swept));
    options.watch.report(options.thresholds - n, options.thresholds);
  }
  std::reverse(out.curve.begin(), out.curve.end());
  out.jump = above_the_jump(out.curve);
  // A tip that is sharpened by noise explains everything, because it leaves the noise in the scan;
  // it must not count.
  double most_expected = 0, least_excess = HUGE_VAL;
  for (const SweptTip& t : out.curve) most_expected = std::max(most_expected, t.expected_nm);
  const auto counts = [&](const SweptTip& t) { return t.expected_nm >= smooths * most_expected; };
  for (const SweptTip& t : out.curve)
    if (counts(t)) least_excess = std::min(least_excess, t.excess());
  for (std::size_t k = 0; k < out.curve.size(); ++k) {
    SweptTip& t = out.curve[k];
    t.consistent = counts(t) && t.excess() <= as_near * std::max(1.0, least_excess);
    if (t.consistent) out.chosen = k;
  }
  if (least_excess > too_much) {
    out.verdict = TipSweepVerdict::none;
    return out;
  }
  const double apart = std::fabs(static_cast<double>(out.chosen) - static_cast<double>(out.jump));
  out.verdict = apart <= std::max(1.0, near_jump * options.thresholds)
                    ? TipSweepVerdict::clear
                    : TipSweepVerdict::disagreement;
  return out;
}

double outer_threshold_nm(const AfmNoise& noise, double pixels, double samples) {
  validate(noise);
  constexpr double risk = 0.05;
  const double sigma = std::sqrt(noise.variance_nm2());
  // Either no pixel deviates by more than half of the threshold, or no pair of pixels that the tip
  // can bring together differs by more than the threshold.
  const double singly = 2 * normal_quantile_above(risk / (2 * pixels));
  const double in_pairs = std::numbers::sqrt2 * normal_quantile_above(risk / (pixels * samples));
  return sigma * std::min(singly, in_pairs);
}

std::vector<double> unconstrained_directions(const Tip& tip, double drop_nm) {
  constexpr int directions = 36;
  std::vector<double> out;
  for (int n = 0; n < directions; ++n) {
    const double angle = 2 * std::numbers::pi * n / directions;
    double lowest = 0;
    for (double r = 1;; r += 0.5) {
      const int i = tip.apex_x + static_cast<int>(std::lround(r * std::cos(angle)));
      const int j = tip.apex_y + static_cast<int>(std::lround(r * std::sin(angle)));
      if (i < 0 || j < 0 || i >= tip.z_nm.width() || j >= tip.z_nm.height()) break;
      lowest = std::min(lowest, tip.z_nm(i, j));
    }
    if (-lowest <= drop_nm) out.push_back(360.0 * n / directions);
  }
  return out;
}

}  // namespace surf
