// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/window_scores.h"

#include <algorithm>
#include <cmath>

namespace surf {
namespace {

constexpr double least_share = 0.5;  // of a window's samples that must be valid

double squared(double v) { return v * v; }

}  // namespace

Grid<double> DifferenceErrors::total() const {
  Grid<double> out(random.width(), random.height());
  for (std::size_t i = 0; i < out.size(); ++i) {
    double variance = squared(random.data()[i]);
    if (!systematic.empty()) variance += squared(systematic.data()[i]);
    for (const Grid<double>& pattern : common) variance += squared(pattern.data()[i]);
    out.data()[i] = std::sqrt(variance);
  }
  return out;
}

WindowScores::WindowScores(const DifferenceErrors& e, std::vector<int> sizes)
    : sizes_(std::move(sizes)), weight_(e.random.width(), e.random.height()),
      weights_(e.random.width(), e.random.height()) {
  const int w = weight_.width(), h = weight_.height();
  const Grid<double> total = e.total();
  for (std::size_t i = 0; i < weight_.size(); ++i)
    weight_.data()[i] = e.valid.includes(i) ? 1 / squared(total.data()[i]) : 0;
  weights_.fill([&](std::size_t i) { return weight_.data()[i]; });
  BoxSums samples(w, h), random(w, h);
  samples.fill([&](std::size_t i) { return weight_.data()[i] > 0 ? 1.0 : 0.0; });
  random.fill([&](std::size_t i) { return squared(e.random.data()[i] * weight_.data()[i]); });
  std::vector<BoxSums> coherent;
  const auto add = [&](const Grid<double>& pattern) {
    coherent.emplace_back(w, h);
    coherent.back().fill([&](std::size_t i) { return pattern.data()[i] * weight_.data()[i]; });
  };
  if (!e.systematic.empty()) add(e.systematic);
  for (const Grid<double>& pattern : e.common) add(pattern);
  for (const int size : sizes_) {
    Grid<float>& out = per_deviation_.emplace_back(w - size + 1, h - size + 1);
    const double inflation = e.correlation.inflation(size);
    for (int y = 0; y < out.height(); ++y)
      for (int x = 0; x < out.width(); ++x) {
        if (samples.square(x, y, size) < least_share * size * size) continue;
        double variance = inflation * random.square(x, y, size);
        for (const BoxSums& sums : coherent) variance += squared(sums.square(x, y, size));
        out(x, y) = static_cast<float>(1 / std::sqrt(variance));
      }
  }
}

std::vector<Window> WindowScores::above(const Grid<double>& difference, double threshold) const {
  std::vector<Window> found;
  each([&](std::size_t i) { return difference.data()[i]; },
       [&](std::size_t k, int x, int y, double score) {
         if (std::abs(score) < threshold) return;
         const double mean =
             score / (double(per_deviation_[k](x, y)) * weights_.square(x, y, sizes_[k]));
         found.push_back({x, y, sizes_[k], score, mean});
       });
  std::ranges::stable_sort(found, [](const Window& a, const Window& b) {
    return std::abs(a.score) > std::abs(b.score);
  });
  return found;
}

Grid<double> WindowScores::centred(const Grid<double>& difference) const {
  Grid<double> out(weight_.width(), weight_.height());
  each([&](std::size_t i) { return difference.data()[i]; },
       [&](std::size_t k, int x, int y, double score) {
         double& most = out(x + sizes_[k] / 2, y + sizes_[k] / 2);
         most = std::max(most, std::abs(score));
       });
  return out;
}

WindowScores::Sums WindowScores::sums_of(const Grid<double>& difference) const {
  return weighted([&](std::size_t i) { return difference.data()[i]; });
}

double WindowScores::score(const Sums& sums, const Window& window) const {
  const auto k = std::size_t(std::ranges::find(sizes_, window.size) - sizes_.begin());
  return sums.square(window.x, window.y, window.size) *
         double(per_deviation_[k](window.x, window.y));
}

}  // namespace surf
