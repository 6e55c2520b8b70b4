// SPDX-License-Identifier: GPL-3.0-or-later
#include "afm/slope_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <queue>

namespace surf {
namespace {

constexpr std::size_t bins_per_slab = 8;
constexpr double most_bins = 1 << 20;

/// Offsets of all samples for a given slope, in bins.
class Offsets {
 public:
  explicit Offsets(const Votes& votes)
      : votes_(votes), residual_(votes.size()), bin_(votes.size()) {}

  /// Bins the offsets. The largest number of samples in any slab of half height `half` is then at
  /// most `most_in(bins_per_slab + 1)` and at least `most_in(bins_per_slab)`.
  void fill(double a, double b, double half) {
    const auto fa = static_cast<float>(a), fb = static_cast<float>(b);
    const std::size_t n = votes_.size();
    for (std::size_t i = 0; i < n; ++i)
      residual_[i] = votes_.z[i] - fa * votes_.u[i] - fb * votes_.v[i];
    const auto [lowest, highest] = range();
    lowest_ = lowest;
    height_ =
        std::max(2 * half / bins_per_slab, (static_cast<double>(highest) - lowest) / most_bins);
    const auto bins = static_cast<std::int32_t>((highest - lowest) / height_) + 2;
    counts_.assign(static_cast<std::size_t>(bins) + bins_per_slab + 1, 0);
    const auto per_nm = static_cast<float>(1 / height_);
    for (std::size_t i = 0; i < n; ++i)
      bin_[i] = std::min(bins - 1, static_cast<std::int32_t>((residual_[i] - lowest) * per_nm));
    for (std::size_t i = 0; i < n; ++i) ++counts_[static_cast<std::size_t>(bin_[i])];
  }

  /// The largest number of samples in `width` adjacent bins, and the middle of these bins.
  std::pair<std::size_t, double> most_in(std::size_t width) const {
    unsigned sum = 0, most = 0;
    std::size_t at = 0;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      sum += counts_[i];
      if (i >= width) sum -= counts_[i - width];
      if (sum > most) most = sum, at = i;
    }
    return {most,
            lowest_ + (static_cast<double>(at) + 1 - 0.5 * static_cast<double>(width)) * height_};
  }

 private:
  /// Computed in lanes, which a compiler may keep in one vector.
  std::pair<float, float> range() const {
    constexpr std::size_t lanes = 16;
    float low[lanes], high[lanes];
    std::fill_n(low, lanes, INFINITY);
    std::fill_n(high, lanes, -INFINITY);
    const std::size_t whole = residual_.size() / lanes * lanes;
    for (std::size_t i = 0; i < whole; i += lanes) {
      for (std::size_t k = 0; k < lanes; ++k) {
        low[k] = residual_[i + k] < low[k] ? residual_[i + k] : low[k];
        high[k] = residual_[i + k] > high[k] ? residual_[i + k] : high[k];
      }
    }
    for (std::size_t i = whole; i < residual_.size(); ++i) {
      low[0] = std::min(low[0], residual_[i]);
      high[0] = std::max(high[0], residual_[i]);
    }
    return {*std::min_element(low, low + lanes), *std::max_element(high, high + lanes)};
  }

  const Votes& votes_;
  std::vector<float> residual_;
  std::vector<std::int32_t> bin_;
  std::vector<unsigned> counts_;
  double lowest_ = 0, height_ = 1;
};

SlopedPlane count(Offsets& offsets, double a, double b, double tolerance) {
  offsets.fill(a, b, tolerance);
  const auto [most, offset] = offsets.most_in(bins_per_slab);
  return {a, b, offset, most};
}

struct Box {
  double a, b, half;
  std::size_t bound;
  // Of boxes with equal bounds, the smaller comes first: it leads to a plane sooner.
  bool operator<(const Box& other) const {
    return bound != other.bound ? bound < other.bound : half > other.half;
  }
};

}  // namespace

SlopedPlane count_votes(const Votes& votes, double a, double b, double tolerance) {
  Offsets offsets(votes);
  return count(offsets, a, b, tolerance);
}

SlopedPlane search_slopes(const Votes& votes, const SlopeSearch& search,
                          const std::vector<SlopedPlane>& known, std::size_t& evaluated,
                          bool& complete) {
  Offsets offsets(votes);
  SlopedPlane best = count(offsets, 0, 0, search.tolerance);
  for (const SlopedPlane& k : known) {
    const SlopedPlane here = count(offsets, k.a, k.b, search.tolerance);
    if (here.votes > best.votes) best = here;
  }
  std::size_t done = 1 + known.size();
  std::priority_queue<Box> open;
  open.push({0, 0, search.largest_slope, votes.size()});
  const auto worth = [&](std::size_t bound) {
    return static_cast<double>(bound) > (1 + search.slack) * static_cast<double>(best.votes);
  };
  while (!open.empty() && worth(open.top().bound)) {
    if (done >= search.limit) {
      complete = false;
      break;
    }
    search.watch.check();
    const Box box = open.top();
    open.pop();
    const double half = box.half / 2;
    for (const double a : {box.a - half, box.a + half}) {
      for (const double b : {box.b - half, box.b + half}) {
        const SlopedPlane here = count(offsets, a, b, search.tolerance);
        if (here.votes > best.votes) best = here;
        ++done;
        // The corner of the box is off by 2 half: fine enough.
        if (4 * half <= search.tolerance) continue;
        offsets.fill(a, b, search.tolerance + 2 * half);
        ++done;
        const std::size_t bound = std::min(box.bound, offsets.most_in(bins_per_slab + 1).first);
        if (worth(bound)) open.push({a, b, half, bound});
      }
    }
  }
  evaluated += done;
  return best;
}

}  // namespace surf
