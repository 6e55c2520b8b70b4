// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/fit_filter_bank.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "bank_engine.h"
#include "core/argument.h"
#include "sem/model/model_input.h"
#include "surf/core/error.h"

namespace surf {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using facet::Block;

// Above it, errors are many times larger on surfaces slightly different from the training surfaces:
// docs/explanation/filter_bank.md.
constexpr double trusted_condition = 100;
constexpr double pixels_per_unknown = 20;

/// The triangle of a QR decomposition, which is all that least squares need from the rows.
MatrixXd triangle(MatrixXd& rows) {
  const Eigen::Index n = rows.cols();
  if (rows.rows() < n) {
    const Eigen::Index have = rows.rows();
    rows.conservativeResize(n, n);
    rows.bottomRows(n - have).setZero();
  }
  const Eigen::HouseholderQR<Eigen::Ref<MatrixXd>> qr(rows);
  return qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
}

void merge(MatrixXd& sum, const MatrixXd& next) {
  if (next.size() == 0) return;
  if (sum.size() == 0) {
    sum = next;
    return;
  }
  MatrixXd both(sum.rows() + next.rows(), sum.cols());
  both << sum, next;
  sum = triangle(both);
}

/// Triangles of the data of all pixels, with columns 1 and outputs. For each channel, the same
/// columns and the image, weighted.
struct Triangles {
  MatrixXd outputs;
  std::vector<MatrixXd> channels;
  std::int64_t pixels = 0;
};

/// The used pixels of a block, one per row: 1 and the bank's outputs; and their indices.
struct Rows {
  MatrixXd outputs;
  std::vector<std::size_t> pixels;
};

Rows collect(const TrainingImage& image, const Block& block, int columns,
             const std::vector<AlignedVector<double>>& scales) {
  Rows rows;
  const std::size_t width = image.field.z_nm.width();
  std::vector<int> at;
  for (int y = 0; y < block.rows; ++y)
    for (int x = 0; x < block.width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(block.y + y) * width + block.x + x;
      if (!image.used.empty() && image.used.data()[pixel] == 0) continue;
      rows.pixels.push_back(pixel);
      at.push_back(y * 3 * columns + x);
    }
  rows.outputs.resize(static_cast<Eigen::Index>(at.size()),
                      1 + 3 * static_cast<Eigen::Index>(scales.size()));
  rows.outputs.col(0).setOnes();
  for (std::size_t s = 0; s < scales.size(); ++s)
    for (int kind = 0; kind < 3; ++kind)
      for (std::size_t i = 0; i < at.size(); ++i)
        rows.outputs(static_cast<Eigen::Index>(i), 1 + 3 * static_cast<Eigen::Index>(s) + kind) =
            scales[s][at[i] + kind * columns];
  return rows;
}

/// With `misfit`, the variance of each channel beyond the noise, the weight of a pixel is 1 /
/// (standard error^2 + misfit).
Triangles reduce(const TrainingImage& image, const Rows& rows, const std::vector<double>& misfit) {
  Triangles result;
  result.pixels = static_cast<std::int64_t>(rows.pixels.size());
  const Eigen::Index count = rows.outputs.rows(), outputs = rows.outputs.cols();
  if (count == 0) return result;
  for (std::size_t c = 0; c < image.images.size(); ++c) {
    MatrixXd weighted(count, outputs + 1);
    weighted << rows.outputs, VectorXd::Zero(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      weighted(i, outputs) = image.images[c].data()[rows.pixels[i]];
      if (!misfit.empty() && !image.standard_errors.empty()) {
        const double error = image.standard_errors[c].data()[rows.pixels[i]];
        weighted.row(i) /= std::sqrt(error * error + misfit[c]);
      }
    }
    result.channels.push_back(triangle(weighted));
  }
  MatrixXd plain = rows.outputs;
  result.outputs = triangle(plain);
  return result;
}

Triangles reduce(const std::vector<TrainingImage>& images, const FilterBankParameters& bank,
                 int threads, const std::vector<double>& misfit) {
  Triangles sum;
  sum.channels.resize(images.front().images.size());
  for (const TrainingImage& image : images) {
    const HeightField& field = image.field;
    const BankEngine<double> engine(
        bank, field.pitch_x_nm, field.pitch_y_nm,
        {.edge = image.edge, .threads = threads, .double_precision = true});
    // Merged in the order of the blocks, independent of the threads.
    std::vector<Triangles> parts(engine.blocks(field.z_nm).size());
    engine.invariants(field.z_nm,
                      [&](std::size_t i, const Block& block, int columns, const auto& scales) {
                        parts[i] = reduce(image, collect(image, block, columns, scales), misfit);
                      });
    for (const Triangles& part : parts) {
      if (part.pixels == 0) continue;
      merge(sum.outputs, part.outputs);
      for (std::size_t c = 0; c < sum.channels.size(); ++c)
        merge(sum.channels[c], part.channels[c]);
      sum.pixels += part.pixels;
    }
  }
  return sum;
}

/// The outputs' principal components: scores are (outputs - mean) times `directions`.
struct Components {
  VectorXd mean;
  MatrixXd directions;
  std::vector<double> eigenvalues;
};

Components principal_components(const MatrixXd& outputs, std::int64_t pixels, double cutoff) {
  Components result;
  const Eigen::Index n = outputs.cols() - 1;
  const double count = static_cast<double>(pixels);
  result.mean = outputs.row(0).tail(n).transpose() / outputs(0, 0);
  MatrixXd standard = outputs.bottomRightCorner(n, n) / std::sqrt(count);
  VectorXd unit = VectorXd::Zero(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const double deviation = standard.col(j).norm();
    // A constant output contains no information; rounding must not give it any.
    if (deviation > 1e-9 * std::abs(result.mean[j])) unit[j] = 1 / deviation;
  }
  standard = standard * unit.asDiagonal();
  const Eigen::JacobiSVD<MatrixXd> svd(standard, Eigen::ComputeThinV);
  Eigen::Index kept = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double eigenvalue = svd.singularValues()[i] * svd.singularValues()[i];
    result.eigenvalues.push_back(eigenvalue);
    if (eigenvalue > 0 && eigenvalue >= cutoff) ++kept;
  }
  result.directions = unit.asDiagonal() * svd.matrixV().leftCols(kept);
  return result;
}

/// Fits a channel by least squares. Returns the condition number of the matrix.
double solve(const MatrixXd& weighted, const Components& components, FilterBankChannel& channel) {
  const Eigen::Index n = weighted.cols() - 2, kept = components.directions.cols();
  MatrixXd a(weighted.rows(), kept + 1);
  a.col(0) = weighted.col(0);
  a.rightCols(kept) = (weighted.middleCols(1, n) - weighted.col(0) * components.mean.transpose()) *
                      components.directions;
  const VectorXd singular = Eigen::JacobiSVD<MatrixXd>(a).singularValues();
  const double condition = singular[0] / std::max(singular[kept], 1e-16 * singular[0]);
  // Columns of equal length lose fewer digits.
  VectorXd length = a.colwise().norm().transpose();
  for (double& l : length)
    if (l == 0) l = 1;
  a = a * length.cwiseInverse().asDiagonal();
  const Eigen::JacobiSVD<MatrixXd> svd(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const VectorXd solution = svd.solve(weighted.rightCols(1)).col(0).cwiseQuotient(length);
  const VectorXd coefficients = components.directions * solution.tail(kept);
  channel.offset = solution[0] - components.mean.dot(coefficients);
  for (Eigen::Index i = 0; i < n; i += 3) {
    channel.slope.push_back(coefficients[i]);
    channel.max_curvature.push_back(coefficients[i + 1]);
    channel.min_curvature.push_back(coefficients[i + 2]);
  }
  return condition;
}

void solve(const std::vector<MatrixXd>& weighted, const Components& components,
           FilterBankFit& fit) {
  fit.condition_number = 0;
  for (std::size_t c = 0; c < weighted.size(); ++c) {
    FilterBankChannel& channel = fit.parameters.channels[c];
    channel = {channel.name, 0, {}, {}, {}};
    fit.condition_number = std::max(fit.condition_number, solve(weighted[c], components, channel));
  }
}

void warn(FilterBankFit& fit, std::int64_t pixels) {
  if (fit.components == 0)
    fit.warnings.push_back(
        "The surfaces have no relief to learn from: the model is a constant. "
        "Train on rougher ones");
  if (fit.condition_number > trusted_condition)
    fit.warnings.push_back(
        fmt::format("The least squares is ill-conditioned (condition number {:.2g}, {:.0f} at most "
                    "is sound): the model may be "
                    "far off on surfaces that it was not trained on. Raise the eigenvalue cut-off "
                    "or train on more kinds of "
                    "surfaces",
                    fit.condition_number, trusted_condition));
  if (static_cast<double>(pixels) < pixels_per_unknown * (fit.components + 1))
    fit.warnings.push_back(
        fmt::format("{} pixels are few for {} unknowns a channel: train on more or larger images",
                    pixels, fit.components + 1));
}

}  // namespace

FilterBankFit fit_filter_bank(const std::vector<TrainingImage>& images,
                              const std::vector<std::string>& channels,
                              const FilterBankFitOptions& options) {
  require_not_negative(options.eigenvalue_cutoff, "eigenvalue cut-off");
  validate(images);
  if (channels.size() != images.front().images.size())
    throw InvalidInput("training",
                       fmt::format("there are {} names for {} channels", channels.size(),
                                   images.front().images.size()),
                       "Give one for each channel");
  FilterBankFit fit;
  FilterBankParameters& bank = fit.parameters;
  bank.scales = options.scales;
  bank.multi_resolution = options.multi_resolution;
  for (const std::string& name : channels) {
    const std::vector<double> none(options.scales.size());
    bank.channels.push_back({name, 0, none, none, none});
  }
  make_filter_bank({}, bank);  // throws if something is out of range
  for (const TrainingImage& image : images) check_span(image.field);

  const Triangles sum = reduce(images, bank, options.threads, {});
  if (sum.pixels == 0) throw InvalidInput("training", "no pixel is used", "Mark some as used");
  const Components components =
      principal_components(sum.outputs, sum.pixels, options.eigenvalue_cutoff);
  fit.eigenvalues = components.eigenvalues;
  fit.components = static_cast<int>(components.directions.cols());
  solve(sum.channels, components, fit);
  fit.residuals = residuals_of(*make_filter_bank({}, bank), images, options.threads);
  const bool known_errors =
      std::any_of(images.begin(), images.end(),
                  [](const TrainingImage& image) { return !image.standard_errors.empty(); });
  if (known_errors) {
    std::vector<double> misfit;
    for (const ModelResidual& r : fit.residuals) misfit.push_back(r.rms * r.rms);
    solve(reduce(images, bank, options.threads, misfit).channels, components, fit);
    fit.residuals = residuals_of(*make_filter_bank({}, bank), images, options.threads);
  }
  warn(fit, sum.pixels);
  return fit;
}

}  // namespace surf
