// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/calibration.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/argument.h"
#include "sem/calibration/calibration_warnings.h"
#include "surf/core/error.h"

namespace surf {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t most_channels = 8;
constexpr double infinity = std::numeric_limits<double>::infinity();
/// Smallest ratio of an eigenvalue of the scaled normal matrix to the largest one that is not just
/// rounding of images stored as 32-bit floats.
constexpr double rounding = 1e-13;

void check(const CalibrationImages& images, const CalibrationOptions& options) {
  const auto fail = [](const char* subject, const std::string& reason, const char* remedy) {
    throw InvalidInput(subject, reason, remedy);
  };
  const std::size_t n = images.channels.size();
  if (n < 1 || n > most_channels || n != images.simulated.size())
    fail("calibration", fmt::format("{} channels with {} images", n, images.simulated.size()),
         "Give one simulated image for each of 1 to 8 channels");
  const auto same = [&](int width, int height) {
    return width == images.real.width() && height == images.real.height();
  };
  for (std::size_t i = 0; i < n; ++i) {
    const Grid<double>& image = images.simulated[i];
    if (!same(image.width(), image.height()))
      fail("calibration",
           fmt::format("the image has {} x {} pixels, {} has {} x {}", images.real.width(),
                       images.real.height(), images.channels[i], image.width(), image.height()),
           "Register and resample them to the same pixels first");
  }
  if (!images.used.empty() && !same(images.used.width(), images.used.height()))
    fail("calibration mask", "it has another size than the image", "Give one of the image's size");
  if (!images.weights.empty() && !same(images.weights.width(), images.weights.height()))
    fail("calibration weights", "they have another size than the image",
         "Give one weight per pixel");
  for (const double w : images.weights.data())
    if (w < 0)
      fail("calibration weights", "there are some below 0",
           "Give 1 / variance, or 0 to leave a pixel out");
  if (options.offset) require_finite(*options.offset, "calibration offset");
  if (!(options.highest_condition >= 1))
    throw UsageError("calibration highest_condition", "it is below 1", "Give 1 or above");
  if (!(options.black < options.white))
    throw UsageError("calibration levels", "black is not below white", "Exchange them");
  if (options.ratios.empty()) return;
  if (options.ratios.size() != n || options.ratios.front() != 1)
    throw UsageError(
        "calibration ratios",
        fmt::format("{} for {} channels, or the first is not 1", options.ratios.size(), n),
        "Give one per channel, relative to the first");
  for (const double r : options.ratios) require_finite(r, "calibration ratio");
}

/// The weights of the pixels; 0 for those that do not count.
Grid<double> pixel_weights(const CalibrationImages& images, const CalibrationOptions& options,
                           Calibration& out) {
  Grid<double> weights(images.real.width(), images.real.height());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (!images.used.empty() && !images.used.data()[i]) continue;
    const double w = images.weights.empty() ? 1 : images.weights.data()[i];
    const double e = images.real.data()[i];
    bool counts = std::isfinite(w) && w > 0 && std::isfinite(e);
    for (const auto& image : images.simulated) counts = counts && std::isfinite(image.data()[i]);
    if (!counts) continue;
    if (e <= options.black || e >= options.white) {
      ++out.saturated;
      continue;
    }
    weights.data()[i] = w;
    ++out.pixels;
  }
  return weights;
}

/// The fitted columns: the channels, or their only combination.
ModelImages columns_of(const CalibrationImages& images, const std::vector<double>& ratios) {
  if (ratios.empty()) return images.simulated;
  Grid<double> sum(images.real.width(), images.real.height());
  for (std::size_t c = 0; c < ratios.size(); ++c)
    for (std::size_t i = 0; i < sum.size(); ++i)
      sum.data()[i] += ratios[c] * images.simulated[c].data()[i];
  return {std::move(sum)};
}

struct Moments {
  double weight = 0, mean_real = 0, real = 0;  // real: sum of weight (E - mean)^2
  VectorXd mean, cross;                        // means of the columns; products with E
  MatrixXd square;                             // of the columns
};

/// Sums relative to the means, or to 0 and the offset if that is known. They are computed in two
/// passes, so that they are exact for signals that vary little.
Moments moments(const Grid<double>& real, const ModelImages& columns, const Grid<double>& weights,
                std::optional<double> offset) {
  const auto n = static_cast<Eigen::Index>(columns.size());
  Moments m;
  m.mean = m.cross = VectorXd::Zero(n);
  m.square = MatrixXd::Zero(n, n);
  VectorXd x(n);
  const auto read = [&](std::size_t i) {
    for (Eigen::Index c = 0; c < n; ++c) x[c] = columns[static_cast<std::size_t>(c)].data()[i];
  };
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double w = weights.data()[i];
    if (w == 0) continue;
    read(i);
    m.weight += w;
    m.mean_real += w * real.data()[i];
    m.mean += w * x;
  }
  m.mean_real /= m.weight;
  m.mean /= m.weight;
  if (offset) {
    m.mean_real = *offset;
    m.mean.setZero();
  }
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double w = weights.data()[i];
    if (w == 0) continue;
    read(i);
    x -= m.mean;
    const double e = real.data()[i] - m.mean_real;
    m.real += w * e * e;
    m.cross += w * e * x;
    m.square += w * x * x.transpose();
  }
  return m;
}

struct Solution {
  VectorXd gains;
  MatrixXd inverse;  // of the normal matrix, restricted to what is determined
  double condition = 1;
};

/// Solves the normal equations, for columns scaled to length 1, by eigenvalues. For dependent
/// columns this gives the smallest solution.
Solution solve(const Moments& m, const std::vector<std::string>& names) {
  const VectorXd scale = m.square.diagonal().cwiseSqrt();
  const Eigen::Index n = scale.size();
  VectorXd unit = VectorXd::Zero(n);
  bool constant = false;
  for (Eigen::Index c = 0; c < n; ++c) {
    const double size = scale[c] / std::sqrt(m.weight);
    if (size == 0 && m.mean[c] == 0)
      throw InvalidInput(names[static_cast<std::size_t>(c)],
                         "the simulated image is 0 in all pixels that count",
                         "Leave this channel out");
    // A constant channel cannot be distinguished from the offset.
    if (size <= 1e-7 * std::fabs(m.mean[c])) constant = true;
    else unit[c] = 1 / scale[c];
  }
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(unit.asDiagonal() * m.square *
                                                      unit.asDiagonal());
  const VectorXd values = eigen.eigenvalues();
  VectorXd inverse = VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i)
    if (values[i] > rounding * values[n - 1]) inverse[i] = 1 / values[i];
  Solution s;
  const bool dependent = constant || !(values[0] > rounding * values[n - 1]);
  s.condition = dependent ? infinity : std::sqrt(values[n - 1] / values[0]);
  s.inverse = unit.asDiagonal() * eigen.eigenvectors() * inverse.asDiagonal() *
              eigen.eigenvectors().transpose() * unit.asDiagonal();
  s.gains = s.inverse * m.cross;
  return s;
}

/// Sets the covariance of all gains and the offset from that of the free gains.
void set_covariance(Calibration& c, const Moments& m, const Solution& s, double variance,
                    bool offset_fitted, const std::vector<double>& ratios) {
  const std::size_t n = c.channels.size() + 1;
  c.covariance.assign(n * n, 0);
  if (c.outcome == CalibrationOutcome::undetermined) {
    for (std::size_t i = 0; i < n - (offset_fitted ? 0 : 1); ++i)
      c.covariance[i * n + i] = infinity;
    return;
  }
  const auto free = s.gains.size();
  MatrixXd to_all = MatrixXd::Zero(static_cast<Eigen::Index>(n), free);  // from the free gains
  for (std::size_t i = 0; i + 1 < n; ++i)
    to_all(static_cast<Eigen::Index>(i), ratios.empty() ? static_cast<Eigen::Index>(i) : 0) =
        ratios.empty() ? 1 : ratios[i];
  if (offset_fitted) to_all.row(static_cast<Eigen::Index>(n) - 1) = -m.mean.transpose();
  MatrixXd all = variance * to_all * s.inverse * to_all.transpose();
  if (offset_fitted)
    all(static_cast<Eigen::Index>(n) - 1, static_cast<Eigen::Index>(n) - 1) += variance / m.weight;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      c.covariance[i * n + j] = all(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
}

/// Returns the sum of weight r^2 and sets the correlation of neighbours.
double residuals(Calibration& c, const CalibrationImages& images, const Grid<double>& weights) {
  const Grid<double> fit = calibrated_image(c, images.simulated);
  double sum = 0, squares = 0, products = 0;
  for (int y = 0; y < weights.height(); ++y) {
    for (int x = 0; x < weights.width(); ++x) {
      if (weights(x, y) == 0) continue;
      const double r = images.real(x, y) - fit(x, y);
      sum += weights(x, y) * r * r;
      if (x == 0 || weights(x - 1, y) == 0) continue;
      const double w = std::sqrt(weights(x, y) * weights(x - 1, y)),
                   before = images.real(x - 1, y) - fit(x - 1, y);
      products += w * r * before;
      squares += 0.5 * (weights(x, y) * r * r + weights(x - 1, y) * before * before);
    }
  }
  c.residual_correlation = squares > 0 ? products / squares : 0;
  return sum;
}

}  // namespace

double Calibration::gain_stderr(std::size_t channel) const {
  return std::sqrt(covariance.at(channel * (channels.size() + 2)));
}

double Calibration::offset_stderr() const { return std::sqrt(covariance.back()); }

Calibration calibrate(const CalibrationImages& images, const CalibrationOptions& options) {
  check(images, options);
  Calibration c;
  c.channels = images.channels;
  const Grid<double> weights = pixel_weights(images, options, c);
  const ModelImages columns = columns_of(images, options.ratios);
  const auto fitted = static_cast<std::int64_t>(columns.size()) + (options.offset ? 0 : 1);
  if (c.pixels <= fitted)
    throw InvalidInput("calibration",
                       fmt::format("{} pixels count, too few for {} numbers", c.pixels, fitted),
                       c.saturated ? "Nearly all are saturated: check black and white"
                                   : "Check the mask, and that the images are finite");
  const Moments m = moments(images.real, columns, weights, options.offset);
  const Solution s =
      solve(m, options.ratios.empty() ? c.channels : std::vector<std::string>{"simulated image"});
  c.condition_number = s.condition;
  for (std::size_t i = 0; i < c.channels.size(); ++i)
    c.gains.push_back(options.ratios.empty() ? s.gains[static_cast<Eigen::Index>(i)]
                                             : s.gains[0] * options.ratios[i]);
  c.offset = options.offset ? *options.offset : m.mean_real - m.mean.dot(s.gains);
  if (std::isinf(s.condition)) c.outcome = CalibrationOutcome::undetermined;
  const double squares = residuals(c, images, weights);
  c.residual_rms = std::sqrt(squares / m.weight);
  c.explained = m.real > 0 ? 1 - squares / m.real : 0;
  set_covariance(c, m, s, squares / static_cast<double>(c.pixels - fitted), !options.offset,
                 options.ratios);
  judge(c, images, options, weights);
  return c;
}

Grid<double> calibrated_image(const Calibration& calibration, const ModelImages& simulated) {
  if (simulated.size() != calibration.gains.size() || simulated.empty())
    throw InvalidInput(
        "calibrated image",
        fmt::format("{} images for {} gains", simulated.size(), calibration.gains.size()),
        "Give the channels that were calibrated");
  Grid<double> out(simulated.front().width(), simulated.front().height(), calibration.offset);
  for (std::size_t c = 0; c < simulated.size(); ++c) {
    if (simulated[c].width() != out.width() || simulated[c].height() != out.height())
      throw InvalidInput("calibrated image", "the channels differ in size",
                         "Give images of one size");
    for (std::size_t i = 0; i < out.size(); ++i)
      out.data()[i] += calibration.gains[c] * simulated[c].data()[i];
  }
  return out;
}

FilterBankParameters fold(const Calibration& calibration, const FilterBankParameters& bank,
                          const std::string& name) {
  FilterBankParameters out = bank;
  const std::vector<double> none(bank.scales.size(), 0.0);
  out.channels = {{name, calibration.offset, none, none, none}};
  for (std::size_t i = 0; i < calibration.channels.size(); ++i) {
    const auto channel =
        std::ranges::find(bank.channels, calibration.channels[i], &FilterBankChannel::name);
    if (channel == bank.channels.end())
      throw InvalidInput("filter bank",
                         fmt::format("it has no channel '{}'", calibration.channels[i]),
                         "Calibrate with the images of this model");
    const double gain = calibration.gains[i];
    out.channels[0].offset += gain * channel->offset;
    for (std::size_t s = 0; s < none.size(); ++s) {
      out.channels[0].slope[s] += gain * channel->slope.at(s);
      out.channels[0].max_curvature[s] += gain * channel->max_curvature.at(s);
      out.channels[0].min_curvature[s] += gain * channel->min_curvature.at(s);
    }
  }
  return out;
}

}  // namespace surf
