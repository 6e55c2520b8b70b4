// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/blind_tip.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <tuple>

#include <fmt/format.h>

#include "explained.h"
#include "surf/afm/height_range.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "tip_carver.h"

namespace surf {

namespace {

struct Point {
  std::uint32_t scan;
  std::int32_t x, y;
  float misfit;  // how far the scan lies above what the tip can make; for maxima, the height itself
};

void check(const std::vector<HeightField>& scans, const BlindTipOptions& o) {
  if (scans.empty()) throw UsageError("blind tip", "there is no scan", "Give one or several");
  for (const HeightField& scan : scans) {
    validate(scan, "scan");
    if (scan.pitch_x_nm != scans[0].pitch_x_nm || scan.pitch_y_nm != scans[0].pitch_y_nm)
      throw InvalidInput("scans", "they differ in pitch", "Give scans of one pixel size");
    if (o.width > scan.z_nm.width() || o.height > scan.z_nm.height())
      throw InvalidInput("tip size",
                         fmt::format("{} x {} samples are more than the scan's {} x {}", o.width,
                                     o.height, scan.z_nm.width(), scan.z_nm.height()),
                         "Ask for a smaller tip");
  }
  if (o.width < 1 || o.height < 1)
    throw UsageError("tip size", "a tip needs at least one sample", "Ask for 21 x 21, say");
  for (const double nm :
       {o.threshold_nm, o.threshold_y_nm.value_or(0), o.apex_tolerance_nm, o.layer_nm})
    if (!(nm >= 0 && std::isfinite(nm)))
      throw UsageError("threshold", fmt::format("{:g} nm is impossible", nm), "Give 0 nm or more");
  if (!o.start) return;
  validate(*o.start, "tip to start with");
  if (o.start->z_nm.width() != o.width || o.start->z_nm.height() != o.height ||
      o.start->apex_x != o.width / 2 || o.start->apex_y != o.height / 2)
    throw InvalidInput("tip to start with", "its size or apex is another", "Leave it out");
}

// Heights relative to the middle of all scans, so that floats represent them to 1e-7 of the range.
// `slack_nm` exceeds the rounding error of a sum of a few heights: an inequality that holds exactly
// must not fail by rounding.
std::vector<Grid<float>> rebased(const std::vector<HeightField>& scans, float& slack_nm) {
  const HeightRange range = height_range(scans);
  const double middle_nm = 0.5 * (range.low_nm + range.high_nm);
  std::vector<Grid<float>> out;
  slack_nm = static_cast<float>(0x1p-20 * range.span_nm());
  for (const HeightField& s : scans) {
    Grid<float>& z =
        out.emplace_back(s.z_nm.width(), s.z_nm.height(), std::numeric_limits<float>::quiet_NaN());
    for (int y = 0; y < z.height(); ++y)
      for (int x = 0; x < z.width(); ++x)
        if (s.is_valid(x, y)) z(x, y) = static_cast<float>(s.z_nm(x, y) - middle_nm);
  }
  return out;
}

CarvedTip prepared(const BlindTipOptions& o, float slack_nm) {
  CarvedTip tip;
  tip.width = o.width;
  tip.height = o.height;
  tip.apex_x = o.width / 2;
  tip.apex_y = o.height / 2;
  tip.stride = (o.width + 15) / 16 * 16;
  const auto count = static_cast<std::size_t>(tip.stride * tip.height);
  tip.z.assign(count, -std::numeric_limits<float>::infinity());
  tip.mirrored.assign(count, -std::numeric_limits<float>::infinity());
  tip.threshold.assign(count, 0);
  const double along_y = o.threshold_y_nm.value_or(o.threshold_nm);
  for (int j = 0; j < tip.height; ++j)
    for (int i = 0; i < tip.width; ++i) {
      const auto k = static_cast<std::size_t>(j * tip.stride + i);
      const double dx = i - tip.apex_x, dy = j - tip.apex_y, r = std::hypot(dx, dy);
      tip.lower(k, o.start ? static_cast<float>(o.start->z_nm(i, j)) : 0);
      tip.threshold[k] = static_cast<float>(
          slack_nm +
          (r > 0 ? std::hypot(o.threshold_nm * dx / r, along_y * dy / r) : o.threshold_nm));
    }
  tip.apex_tolerance = static_cast<float>(o.apex_tolerance_nm) + slack_nm;
  return tip;
}

// As in the thesis: none of the eight neighbours is higher, and at least two are lower.
bool is_local_maximum(const Grid<float>& z, int x, int y) {
  int lower = 0;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      if (!(z(x + i, y + j) <= z(x, y))) return false;
      lower += z(x + i, y + j) < z(x, y);
    }
  return lower >= 2;
}

// Sorts points so that successive ones share what the processor's caches hold of the scan.
template <class Iterator>
void by_neighbourhood(Iterator begin, Iterator end) {
  constexpr int wide = 64;
  std::sort(begin, end, [](const Point& a, const Point& b) {
    return std::tuple(a.scan, a.x / wide, a.y, a.x) < std::tuple(b.scan, b.x / wide, b.y, b.x);
  });
}

class Reconstruction {
 public:
  Reconstruction(const std::vector<HeightField>& scans, const BlindTipOptions& options,
                 BlindTipSummary& summary)
      : options_(options), summary_(summary), heights_(rebased(scans, slack_nm_)),
        tip_(prepared(options, slack_nm_)), threads_(resolve_threads(options.threads)),
        carvers_(static_cast<std::size_t>(threads_)) {
    for (const Grid<float>& z : heights_) {
      scans_.emplace_back(z, options.layer_nm, options.width, options.height);
      tried_.emplace_back(z.width(), z.height());
      apex_.emplace_back();
    }
  }

  CarvedTip run() {
    // Maxima are few and carry nearly all the information.
    std::vector<Point> maxima = points(true);
    while (carve(maxima)) ++summary_.rounds;
    for (bool changed = !options_.maxima_only; changed;) {
      std::vector<Point> all = points(false);
      changed = carve(all);
      ++summary_.rounds;
      options_.watch.report(summary_.rounds, summary_.rounds + 1);
    }
    return tip_;
  }

 private:
  // The points that the tip cannot have made, the worst first; for maxima, the highest first.
  std::vector<Point> points(bool maxima) {
    std::vector<Point> out;
    for (std::size_t s = 0; s < scans_.size(); ++s) {
      const CarvedScan& scan = scans_[s];
      const int dx = options_.border ? 1 : tip_.width - 1,
                dy = options_.border ? 1 : tip_.height - 1;
      apex_[s] = apex_heights(scan, tip_, threads_);
      const Grid<float> made = explained_height(scan, apex_[s], tip_, threads_);
      for (int y = dy; y < scan.height() - dy; ++y)
        for (int x = dx; x < scan.width() - dx; ++x) {
          const float z = scan.bottom(x, y);
          if (z == -std::numeric_limits<float>::infinity()) continue;
          if (tried_[s](x, y) == version_) continue;  // with the current tip
          if (made(x, y) < z && (!maxima || is_local_maximum(heights_[s], x, y)))
            out.push_back({static_cast<std::uint32_t>(s), x, y, maxima ? z : z - made(x, y)});
        }
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const Point& a, const Point& b) { return a.misfit > b.misfit; });
    return out;
  }

  // Carves by batches of points that all see the same tip, so that the result does not depend on
  // the number of threads. Returns true if the tip has changed by more than rounding.
  bool carve(std::vector<Point>& all) {
    constexpr std::size_t batch = 1024, share = 16;
    bool changed = false;
    for (std::size_t first = 0; first < all.size(); first += batch) {
      options_.watch.check();
      const std::size_t last = std::min(all.size(), first + batch);
      for (TipCarver& carver : carvers_) carver.begin(tip_);
      by_neighbourhood(all.begin() + static_cast<std::ptrdiff_t>(first),
                       all.begin() + static_cast<std::ptrdiff_t>(last));
      parallel_for((last - first + share - 1) / share, threads_, [&](std::size_t unit, int worker) {
        const auto w = static_cast<std::size_t>(worker);
        for (std::size_t p = first + unit * share; p < std::min(last, first + (unit + 1) * share);
             ++p)
          carvers_[w].carve(scans_[all[p].scan], apex_[all[p].scan], all[p].x, all[p].y, tip_);
      });
      summary_.points += static_cast<std::int64_t>(last - first);
      for (std::size_t p = first; p < last; ++p) tried_[all[p].scan](all[p].x, all[p].y) = version_;
      const bool lowered = lower_tip();
      version_ += lowered;
      changed = changed || lowered;
    }
    return changed;
  }

  // Lowers the tip to what the last batch allows, and returns whether that has changed it.
  bool lower_tip() {
    bool lowered = false;
    std::vector<float> target = tip_.z;
    for (const TipCarver& carver : carvers_)
      for (std::size_t k = 0; k < target.size(); ++k)
        if (carver.limits()[k] < tip_.z[k] - tip_.threshold[k])
          target[k] = std::min(target[k], carver.limits()[k] + tip_.threshold[k]);
    for (std::size_t k = 0; k < target.size(); ++k)
      if (target[k] < tip_.z[k]) {
        tip_.lower(k, target[k]);
        lowered = true;
      }
    return lowered;
  }

  const BlindTipOptions& options_;
  BlindTipSummary& summary_;
  float slack_nm_ = 0;
  std::vector<Grid<float>> heights_;
  std::vector<CarvedScan> scans_;
  CarvedTip tip_;
  int version_ = 1;               // of the tip
  std::vector<Grid<int>> tried_;  // tip version that each point was tried with last
  int threads_;
  std::vector<TipCarver> carvers_;
  std::vector<std::vector<float>> apex_;  // of each scan, by the tip of the last `points`
};

}  // namespace

BlindTip blind_tip(const std::vector<HeightField>& scans, const BlindTipOptions& options) {
  check(scans, options);
  BlindTip out;
  const CarvedTip carved = Reconstruction(scans, options, out.summary).run();
  Tip& tip = out.tip;
  tip.pitch() = scans[0].pitch();
  tip.apex_x = carved.apex_x;
  tip.apex_y = carved.apex_y;
  tip.z_nm = Grid<double>(carved.width, carved.height);
  for (int j = 0; j < carved.height; ++j)
    for (int i = 0; i < carved.width; ++i) tip.z_nm(i, j) = std::min(0.0f, carved.at(i, j));
  tip.z_nm(tip.apex_x, tip.apex_y) = 0;
  return out;
}

}  // namespace surf
