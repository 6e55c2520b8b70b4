// SPDX-License-Identifier: GPL-3.0-or-later
#include "variance_line.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "surf/sem/sem_noise.h"

namespace surf {
namespace {

constexpr int most_groups = 10, least_in_group = 3;
constexpr int most_steps = 200;
constexpr double first_cut = 6;

struct Sums {
  double weight = 0, mean = 0, response = 0;  // weighted averages of means and responses
  double xx = 0, xy = 0;                      // relative to the averages
};

struct Working {
  double weight = 0, response = 0;
};

template <class Work>
Sums sums(const std::vector<VariancePoint>& points, const std::vector<char>& used,
          const Work& work) {
  Sums s;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!used[i]) continue;
    const auto [w, response] = work(points[i]);
    s.weight += w, s.mean += w * points[i].mean, s.response += w * response;
  }
  if (!(s.weight > 0)) return s;
  s.mean /= s.weight, s.response /= s.weight;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!used[i]) continue;
    const auto [w, response] = work(points[i]);
    const double dx = points[i].mean - s.mean;
    s.xx += w * dx * dx, s.xy += w * dx * (response - s.response);
  }
  return s;
}

SemNoise noise_of(const VarianceLine& line, double floor) {
  return {line.slope, line.intercept, floor};
}

/// Makes one step of Fisher scoring. Where the variance departs from the line, a point counts only
/// as far as the variance still follows the line.
void step(const std::vector<VariancePoint>& points, const VarianceLineOptions& o,
          VarianceLine& line) {
  const SemNoise old = noise_of(line, o.floor);
  const Sums s = sums(points, line.used, [&](const VariancePoint& p) -> Working {
    const double on_line = old.slope * p.mean + old.intercept, v = old.variance(p.mean);
    const double follows = std::clamp(on_line / (2 * o.floor), 0.0, 1.0);
    if (follows <= 0) return {};
    return {p.freedom * follows * follows / (2 * v * v), on_line + (p.variance - v) / follows};
  });
  if (!(s.weight > 0)) return;
  const bool sloped = !o.constant && s.xx > 1e-14 * s.weight * s.mean * s.mean && s.xx > 0;
  line.slope = sloped ? s.xy / s.xx : 0;
  line.intercept = s.response - line.slope * s.mean;
  const double vs = sloped ? 1 / s.xx : 0;
  line.covariance = {vs, -s.mean * vs, -s.mean * vs, 1 / s.weight + s.mean * s.mean * vs};
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Starts from the line through medians of groups of points with similar means, which structure
/// does not bias.
void start_robustly(const std::vector<VariancePoint>& points, const VarianceLineOptions& o,
                    VarianceLine& line) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
    return points[a].mean != points[b].mean ? points[a].mean < points[b].mean : a < b;
  });
  const std::size_t n = points.size();
  const std::size_t groups = std::clamp<std::size_t>(n / least_in_group, 1, most_groups);
  std::vector<VariancePoint> middles;
  for (std::size_t g = 0; g < groups; ++g) {
    std::vector<double> means, variances, freedoms;
    for (std::size_t i = g * n / groups; i < (g + 1) * n / groups; ++i) {
      const VariancePoint& p = points[order[i]];
      means.push_back(p.mean), freedoms.push_back(p.freedom);
      // The divisor is the median of chi-squared over its mean.
      variances.push_back(p.variance / std::pow(std::max(1 - 2 / (9 * p.freedom), 0.1), 3));
    }
    middles.push_back({median(means), median(variances), median(freedoms)});
  }
  VarianceLine rough;
  rough.used.assign(middles.size(), 1);
  std::vector<double> all;
  for (const VariancePoint& m : middles) all.push_back(m.variance);
  rough.intercept = median(all);
  for (int i = 0; i < 5; ++i) step(middles, o, rough);
  line.slope = rough.slope, line.intercept = rough.intercept;
}

}  // namespace

double score(const VariancePoint& p, double expected) {
  const double k = 2 / (9 * p.freedom);
  return (std::cbrt(std::max(p.variance, 0.0) / expected) - (1 - k)) / std::sqrt(k);
}

VarianceLine fit_variance_line(const std::vector<VariancePoint>& points,
                               const VarianceLineOptions& o) {
  VarianceLine line;
  line.used.assign(points.size(), 1);
  const bool robust = o.cut > 0 && points.size() > 3;
  if (robust) {
    start_robustly(points, o, line);
  } else {
    for (const VariancePoint& p : points)
      line.intercept += p.variance / static_cast<double>(points.size());
  }
  double cut = first_cut;
  for (int i = 0; i < most_steps; ++i) {
    const VarianceLine old = line;
    if (robust) {
      for (std::size_t k = 0; k < points.size(); ++k)
        line.used[k] =
            std::fabs(score(points[k], noise_of(line, o.floor).variance(points[k].mean))) <= cut;
      if (std::ranges::count(line.used, 1) < 3) line.used.assign(points.size(), 1);
    }
    step(points, o, line);
    double largest = o.floor, change = 0;
    for (const VariancePoint& p : points) {
      const double v = noise_of(line, o.floor).variance(p.mean);
      largest = std::max(largest, v);
      change = std::max(change, std::fabs(v - noise_of(old, o.floor).variance(p.mean)));
    }
    const bool cut_reached = !robust || cut <= o.cut;
    cut = std::max(o.cut, 0.85 * cut);
    if (cut_reached && line.used == old.used && change <= 1e-10 * largest) break;
  }
  return line;
}

Curvature fit_curvature(const std::vector<VariancePoint>& points, const VarianceLine& line,
                        double floor) {
  const SemNoise noise = noise_of(line, floor);
  const auto work = [&](const VariancePoint& p) -> Working {
    const double v = noise.variance(p.mean);
    return {p.freedom / (2 * v * v), p.variance - v};
  };
  const Sums s = sums(points, line.used, work);
  if (!(s.xx > 0)) return {};
  const double scale = std::sqrt(s.xx / s.weight);
  double w1 = 0, w2 = 0, w3 = 0, w4 = 0;  // sums of weight times powers of the standardised mean
  const auto each = [&](const auto& visit) {
    for (std::size_t i = 0; i < points.size(); ++i)
      if (line.used[i]) visit(work(points[i]), (points[i].mean - s.mean) / scale);
  };
  each([&](const Working& w, double x) {
    w1 += w.weight, w2 += w.weight * x * x, w3 += w.weight * x * x * x;
  });
  // The square, orthogonal to constants and lines.
  const auto square = [&](double x) { return x * x - w2 / w1 - w3 / w2 * x; };
  double xy = 0, least = 0, largest = 0;
  each([&](const Working& w, double x) {
    w4 += w.weight * square(x) * square(x), xy += w.weight * square(x) * w.response;
    least = std::min(least, x), largest = std::max(largest, x);
  });
  if (!(w4 > 1e-9 * w1)) return {};
  Curvature c{xy / std::sqrt(w4), 0};
  for (const double x : {least, 0.5 * (least + largest), largest})
    c.departure =
        std::max(c.departure, std::fabs(xy / w4 * square(x)) / noise.variance(s.mean + scale * x));
  return c;
}

}  // namespace surf
