// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/mutual_information.h"

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>

#include "surf/core/error.h"

namespace surf {
namespace {

constexpr int fewest_bins = 2, most_bins = 128;
// Bins per standard deviation of Parzen's windows.
constexpr int bins_of_a_window = 4;
constexpr std::size_t fewest_samples = 24;
constexpr double settled_px = 0.01;
constexpr int most_evaluations = 600;

double quantile(std::vector<double>& values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

double deviation_of(const std::vector<double>& values) {
  double mean = 0, sum = 0;
  for (const double v : values) mean += v;
  mean /= static_cast<double>(values.size());
  for (const double v : values) sum += (v - mean) * (v - mean);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

std::vector<double> values_of(const BlurLevel& level) {
  std::vector<double> values;
  for (const BlurLevel::Sample& sample : level.samples) values.push_back(sample.value);
  return values;
}

/// Takes as many values of the AFM's image as the SEM has samples, so that the same rule applies to
/// both.
std::vector<double> afm_values_of(const BlurLevel& level) {
  std::vector<double> values;
  const Grid<double>& grid = level.afm.samples();
  for (std::size_t i = 0; i < grid.size();
       i += std::max<std::size_t>(1, grid.size() / std::max<std::size_t>(1, level.samples.size())))
    if (level.afm.is_valid(static_cast<int>(i) % grid.width(), static_cast<int>(i) / grid.width()))
      values.push_back(grid.data()[i]);
  return values;
}

/// Convolves one axis of a table with Gaussian windows; values that would fall outside stay in the
/// last bin.
void spread(std::vector<double>& table, int rows, int columns, bool along_rows, double sigma) {
  const int n = along_rows ? columns : rows;
  const int reach = std::min(n - 1, static_cast<int>(std::ceil(4 * sigma)));
  if (reach < 1 || !(sigma > 0)) return;
  std::vector<double> taps;
  double sum = 0;
  for (int i = -reach; i <= reach; ++i)
    taps.push_back(std::exp(-0.5 * i * i / (sigma * sigma))), sum += taps.back();
  std::vector<double> line(static_cast<std::size_t>(n));
  for (int k = 0; k < (along_rows ? rows : columns); ++k) {
    const auto at = [&](int i) -> double& {
      return table[static_cast<std::size_t>(along_rows ? k * columns + i : i * columns + k)];
    };
    std::fill(line.begin(), line.end(), 0.0);
    for (int i = 0; i < n; ++i) {
      const double value = at(i) / sum;
      if (value == 0) continue;
      for (int j = -reach; j <= reach; ++j)
        line[static_cast<std::size_t>(std::clamp(i + j, 0, n - 1))] +=
            value * taps[static_cast<std::size_t>(j + reach)];
    }
    for (int i = 0; i < n; ++i) at(i) = line[static_cast<std::size_t>(i)];
  }
}

struct Search {
  MutualInformation information;
  const Watch& watch;
  nlopt_opt optimiser;
  int evaluations = 0;
  std::exception_ptr failure;
};

double asked(unsigned, const double* x, double*, void* data) {
  auto& search = *static_cast<Search*>(data);
  ++search.evaluations;
  try {
    search.watch.check();
    return search.information({x[0], x[1], x[2], x[3], x[4], x[5]});
  } catch (...) {  // NLopt is C
    search.failure = std::current_exception();
    nlopt_force_stop(search.optimiser);
    return 0;
  }
}

}  // namespace

double bin_width(std::vector<double> values, BinRule rule) {
  if (values.empty()) return 0;
  const double shrink = std::cbrt(static_cast<double>(values.size()));
  if (rule == BinRule::interquartile) {
    const double upper = quantile(values, 0.75), range = upper - quantile(values, 0.25);
    if (range > 0) return 2 * range / shrink;
  }
  return 3.49 * deviation_of(values) / shrink;
}

int JointHistogram::Axis::bin(double value) const {
  return std::clamp(static_cast<int>((value - least) / width), 0, count - 1);
}

JointHistogram::Axis JointHistogram::axis_for(const std::vector<double>& values,
                                              const MutualInformationOptions& options) {
  Axis axis;
  if (values.empty()) return axis;
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  const double rule = bin_width(values, options.bins), range = *largest - *least;
  if (!(rule > 0) || !(range > 0)) return axis;
  const bool parzen = options.estimate == EntropyEstimate::parzen;
  const double wanted = parzen ? rule / bins_of_a_window : rule;
  axis.least = *least;
  axis.count = static_cast<int>(
      std::clamp(std::ceil(range / wanted), double{fewest_bins}, double{most_bins}));
  axis.width = range / axis.count;
  axis.window_bins = parzen ? rule / axis.width : 0;
  return axis;
}

JointHistogram::JointHistogram(const std::vector<double>& a, const std::vector<double>& b,
                               const MutualInformationOptions& options)
    : parzen_(options.estimate == EntropyEstimate::parzen), a_(axis_for(a, options)),
      b_(axis_for(b, options)) {
  clear();
}

void JointHistogram::clear() {
  counts_.assign(static_cast<std::size_t>(a_.count) * static_cast<std::size_t>(b_.count), 0.0);
  asked_.assign(parzen_ ? counts_.size() : 0, 0.0);
}

double JointHistogram::information() const {
  std::vector<double> table = counts_;
  if (parzen_) {
    spread(table, a_.count, b_.count, true, b_.window_bins);
    spread(table, a_.count, b_.count, false, a_.window_bins);
  }
  double total = 0, weight = 0;
  std::vector<double> of_a(static_cast<std::size_t>(a_.count)),
      of_b(static_cast<std::size_t>(b_.count));
  for (std::size_t i = 0; i < table.size(); ++i) {
    total += table[i];
    of_a[i / of_b.size()] += table[i];
    of_b[i % of_b.size()] += table[i];
  }
  if (!(total > 0)) return 0;
  double sum = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double here = parzen_ ? asked_[i] : table[i];
    if (!(here > 0)) continue;
    weight += here;
    // A pair that no window reaches would have the density 0 and contribute -infinity. Its density
    // is set below that of a single pair.
    const double joint = std::max(table[i], 1e-3 / total);
    sum +=
        here *
        std::log(joint * total /
                 (std::max(of_a[i / of_b.size()], joint) * std::max(of_b[i % of_b.size()], joint)));
  }
  return weight > 0 ? sum / weight : 0;
}

MutualInformation::MutualInformation(const BlurLevel& level,
                                     const MutualInformationOptions& options)
    : level_(level), options_(options),
      histogram_(values_of(level), afm_values_of(level), options) {
  for (const BlurLevel::Sample& sample : level.samples)
    sem_bins_.push_back(histogram_.bin_a(sample.value));
  const Grid<double>& afm = level.afm.samples();
  afm_bins_ = Grid<int>(afm.width(), afm.height());
  for (std::size_t i = 0; i < afm.size(); ++i)
    afm_bins_.data()[i] = histogram_.bin_b(afm.data()[i]);
}

double MutualInformation::operator()(const ThreePointMap& corners) {
  const bool parzen = options_.estimate == EntropyEstimate::parzen;
  histogram_.clear();
  std::size_t inside = 0;
  for (std::size_t i = 0; i < level_.samples.size(); ++i) {
    const Point2 p = place(corners, level_.samples[i].shares);
    if (!level_.afm.holds(p.x, p.y)) continue;
    ++inside;
    if (parzen && inside % 2 == 0) {
      histogram_.ask(sem_bins_[i], histogram_.bin_b(level_.afm.value(p.x, p.y)));
    } else if (!options_.partial_volume) {
      histogram_.add(sem_bins_[i], histogram_.bin_b(level_.afm.value(p.x, p.y)), 1);
    } else {
      const double u = level_.afm.column(p.x), v = level_.afm.row(p.y);
      const int x = std::min(static_cast<int>(u), afm_bins_.width() - 2),
                y = std::min(static_cast<int>(v), afm_bins_.height() - 2);
      const double s = u - x, t = v - y;
      histogram_.add(sem_bins_[i], afm_bins_(x, y), (1 - s) * (1 - t));
      histogram_.add(sem_bins_[i], afm_bins_(x + 1, y), s * (1 - t));
      histogram_.add(sem_bins_[i], afm_bins_(x, y + 1), (1 - s) * t);
      histogram_.add(sem_bins_[i], afm_bins_(x + 1, y + 1), s * t);
    }
  }
  return inside < fewest_samples ? 0 : histogram_.information();
}

InformationFit fit_information(const BlurLevel& level, const MutualInformationOptions& options,
                               const ThreePointMap& start, const Watch& watch) {
  InformationFit fit;
  fit.corners = start;
  const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> optimiser(
      nlopt_create(NLOPT_LN_BOBYQA, 6), nlopt_destroy);
  Search search{MutualInformation(level, options), watch, optimiser.get(), 0, nullptr};
  const double reach = std::max(6.0, 4 * level.blur_px);
  std::array<double, 6> lower{}, upper{}, x = start;
  for (std::size_t i = 0; i < 6; ++i) lower[i] = start[i] - reach, upper[i] = start[i] + reach;
  nlopt_set_lower_bounds(optimiser.get(), lower.data());
  nlopt_set_upper_bounds(optimiser.get(), upper.data());
  nlopt_set_max_objective(optimiser.get(), asked, &search);
  nlopt_set_initial_step1(optimiser.get(), std::max(1.0, 0.5 * level.blur_px));
  nlopt_set_xtol_abs1(optimiser.get(), settled_px * std::max(1.0, 0.2 * level.blur_px));
  nlopt_set_maxeval(optimiser.get(), most_evaluations);
  double best = 0;
  const nlopt_result result = nlopt_optimize(optimiser.get(), x.data(), &best);
  fit.evaluations = search.evaluations;
  if (search.failure) std::rethrow_exception(search.failure);
  // If rounding ends the search, nothing is left to gain: this counts as converged.
  const bool ended = result == NLOPT_XTOL_REACHED || result == NLOPT_FTOL_REACHED ||
                     result == NLOPT_SUCCESS || result == NLOPT_ROUNDOFF_LIMITED;
  bool at_limit = false;
  for (std::size_t i = 0; i < 6; ++i)
    at_limit |= x[i] <= lower[i] + settled_px || x[i] >= upper[i] - settled_px;
  if (std::all_of(x.begin(), x.end(), [](double v) { return std::isfinite(v); })) fit.corners = x;
  fit.information = search.information(fit.corners);
  fit.settled = ended && !at_limit;
  return fit;
}

std::array<double, 36> information_covariance(const BlurLevel& level,
                                              const MutualInformationOptions& options,
                                              const ThreePointMap& corners,
                                              double independent_share) {
  // The steps are wide compared to the roughness of the histogram.
  constexpr double step = 0.7;
  MutualInformation information(level, options);
  const double here = information(corners);
  const double n = independent_share * static_cast<double>(overlap_of(level, corners).size());
  std::array<double, 36> negative{};
  const auto at = [&](std::size_t i, double di, std::size_t j, double dj) {
    ThreePointMap c = corners;
    c[i] += di;
    c[j] += dj;
    return information(c);
  };
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const double second =
          i == j ? (at(i, step, i, 0) + at(i, -step, i, 0) - 2 * here) / (step * step)
                 : (at(i, step, j, step) + at(i, -step, j, -step) - at(i, step, j, -step) -
                    at(i, -step, j, step)) /
                       (4 * step * step);
      negative[6 * i + j] = negative[6 * j + i] = -n * second;
    }
  return negative;
}

}  // namespace surf
