// SPDX-License-Identifier: GPL-3.0-or-later
#include "discrepancy.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "afm/normal_numbers.h"
#include "surf/core/error.h"

namespace surf::reconstruction {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

constexpr int taps = 3;                // splines along one axis that a pixel is in
constexpr int per_part = taps * taps;  // splines of one part
// So that the splines' squares add up to 1 in the mean: along one axis they are 0.55.
constexpr double unit_scale = 1 / 0.55;

/// Values of the three quadratic B-splines about a place that is `t` of the way along its cell.
std::array<double, taps> splines(double t) {
  return {0.5 * (1 - t) * (1 - t), 0.5 + t * (1 - t), 0.5 * t * t};
}

struct Part {
  int spacing = 1, columns = 0, rows = 0;
  int first = 0;  // number of its first coefficient
  Grid<double> deviation;
  std::vector<std::array<double, taps>> within;  // splines at each pixel of a cell

  int coefficient(int column, int row) const { return first + row * columns + column; }
};

}  // namespace

struct Discrepancy::Layout {
  int width = 0, height = 0, coefficients = 0, columns = 0, rows = 0;
  std::vector<Part> parts;
  Grid<double> row_jitter;
  int first_row = 0;  // number of the rows' first coefficient
  int local = 0;      // number of coefficients of splines and rows: those before the fields'
  std::vector<Grid<double>> fields;
  bool has_rows() const { return !row_jitter.empty(); }
  Matrix pattern;  // lower triangle

  /// Calls with the cell's pixels and its coefficients, for each cell of the finest part.
  template <class Cell>
  void for_each_cell(const Cell& cell) const {
    if (parts.empty()) return;
    const int step = parts.front().spacing;
    std::vector<int> numbers(parts.size() * per_part);
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        for (std::size_t p = 0; p < parts.size(); ++p) {
          const int c = column * step / parts[p].spacing, r = row * step / parts[p].spacing;
          for (int j = 0; j < taps; ++j)
            for (int i = 0; i < taps; ++i)
              numbers[p * per_part + static_cast<std::size_t>(j * taps + i)] =
                  parts[p].coefficient(c + i, r + j);
        }
        cell(column * step, row * step, std::min((column + 1) * step, width),
             std::min((row + 1) * step, height), numbers);
      }
  }

  /// The splines at a pixel, times the standard deviation there.
  void at(int x, int y, double* out) const {
    const std::size_t i =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    for (const Part& part : parts) {
      const auto &along = part.within[static_cast<std::size_t>(x % part.spacing)],
                 &across = part.within[static_cast<std::size_t>(y % part.spacing)];
      const double scale = part.deviation.data()[i];
      for (int v = 0; v < taps; ++v)
        for (int u = 0; u < taps; ++u) *out++ = scale * across[v] * along[u];
    }
  }

  /// B c. Splines are products of one along x and one along y.
  Grid<double> field(const Vector& c) const {
    Grid<double> out(width, height);
    for (const Part& part : parts) {
      Grid<double> along(width, part.rows);
      for (int r = 0; r < part.rows; ++r)
        for (int x = 0; x < width; ++x) {
          const auto& b = part.within[static_cast<std::size_t>(x % part.spacing)];
          const double* from = &c(part.coefficient(x / part.spacing, r));
          along(x, r) = b[0] * from[0] + b[1] * from[1] + b[2] * from[2];
        }
      for (int y = 0; y < height; ++y) {
        const auto& b = part.within[static_cast<std::size_t>(y % part.spacing)];
        const int r = y / part.spacing;
        for (int x = 0; x < width; ++x)
          out(x, y) += part.deviation(x, y) *
                       (b[0] * along(x, r) + b[1] * along(x, r + 1) + b[2] * along(x, r + 2));
      }
    }
    for (int y = 0; has_rows() && y < height; ++y)
      for (int x = 0; x < width; ++x) out(x, y) += c(first_row + y) * row_jitter(x, y);
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const double by = c(local + static_cast<int>(k));
      for (std::size_t i = 0; i < out.size(); ++i) out.data()[i] += by * fields[k].data()[i];
    }
    return out;
  }

  /// B^T v.
  Vector transpose(const Grid<double>& v) const {
    Vector out = Vector::Zero(coefficients);
    for (const Part& part : parts) {
      Grid<double> along(width, part.rows);
      for (int y = 0; y < height; ++y) {
        const auto& b = part.within[static_cast<std::size_t>(y % part.spacing)];
        const int r = y / part.spacing;
        for (int x = 0; x < width; ++x) {
          const double scaled = part.deviation(x, y) * v(x, y);
          for (int k = 0; k < taps; ++k) along(x, r + k) += b[static_cast<std::size_t>(k)] * scaled;
        }
      }
      for (int r = 0; r < part.rows; ++r)
        for (int x = 0; x < width; ++x) {
          const auto& b = part.within[static_cast<std::size_t>(x % part.spacing)];
          double* to = &out(part.coefficient(x / part.spacing, r));
          for (int k = 0; k < taps; ++k) to[k] += b[static_cast<std::size_t>(k)] * along(x, r);
        }
    }
    for (int y = 0; has_rows() && y < height; ++y)
      for (int x = 0; x < width; ++x) out(first_row + y) += row_jitter(x, y) * v(x, y);
    for (std::size_t k = 0; k < fields.size(); ++k) {
      double sum = 0;
      for (std::size_t i = 0; i < v.size(); ++i) sum += fields[k].data()[i] * v.data()[i];
      out(local + static_cast<int>(k)) = sum;
    }
    return out;
  }
};

Discrepancy::Discrepancy(const std::vector<SemDiscrepancy>& parts, const Grid<double>& row_jitter,
                         const std::vector<Grid<double>>& fields) {
  auto layout = std::make_shared<Layout>();
  layout->row_jitter = row_jitter;
  const Grid<double>& first = parts.empty() ? row_jitter : parts.front().deviation;
  layout->width = first.width(), layout->height = first.height();
  int finest = 0;
  for (const SemDiscrepancy& given : parts) {
    Part part;
    const int wanted = std::max(1, static_cast<int>(std::lround(given.correlation_px)));
    part.spacing = finest == 0 ? wanted : finest * std::max(1, (wanted + finest / 2) / finest);
    if (finest == 0) finest = part.spacing;
    part.columns = (layout->width + part.spacing - 1) / part.spacing + taps - 1;
    part.rows = (layout->height + part.spacing - 1) / part.spacing + taps - 1;
    part.first = layout->coefficients;
    part.deviation = given.deviation;
    for (double& d : part.deviation.data()) d *= unit_scale;
    for (int k = 0; k < part.spacing; ++k) part.within.push_back(splines((k + 0.5) / part.spacing));
    layout->coefficients += part.columns * part.rows;
    layout->parts.push_back(std::move(part));
  }
  if (finest > 0) {
    layout->columns = (layout->width + finest - 1) / finest;
    layout->rows = (layout->height + finest - 1) / finest;
  }
  layout->first_row = layout->coefficients;
  if (layout->has_rows()) layout->coefficients += layout->height;
  std::vector<Eigen::Triplet<double>> entries;
  layout->for_each_cell([&](int, int, int, int, const std::vector<int>& numbers) {
    for (const int a : numbers)
      for (const int b : numbers)
        if (a >= b) entries.emplace_back(a, b, 0.0);
  });
  if (layout->has_rows())
    layout->for_each_cell([&](int, int y0, int, int y1, const std::vector<int>& numbers) {
      for (int y = y0; y < y1; ++y)
        for (const int b : numbers) entries.emplace_back(layout->first_row + y, b, 0.0);
    });
  for (int k = layout->first_row; k < layout->coefficients; ++k) entries.emplace_back(k, k, 0.0);
  layout->pattern.resize(layout->coefficients, layout->coefficients);
  layout->pattern.setFromTriplets(entries.begin(), entries.end());
  layout->pattern.makeCompressed();
  layout->local = layout->coefficients;
  layout->fields = fields;
  layout->coefficients += static_cast<int>(fields.size());
  layout_ = std::move(layout);
}

Discrepancy::~Discrepancy() = default;

struct Discrepancy::Factor::Solver {
  Eigen::SimplicialLLT<Matrix, Eigen::Lower> factor;  // of splines and rows
  // Fields have something in common with all others. So they are eliminated last: `across` is what
  // they have in common, `solved` the same solved by `factor`, `rest` what is left of themselves.
  Eigen::MatrixXd across, solved;
  Eigen::LLT<Eigen::MatrixXd> rest;

  void add_fields(const Layout& layout, const Grid<double>& weight) {
    const int local = layout.local, count = static_cast<int>(layout.fields.size());
    if (count == 0) return;
    across.resize(local, count), solved.resize(local, count);
    Eigen::MatrixXd own = Eigen::MatrixXd::Identity(count, count);
    for (int k = 0; k < count; ++k) {
      Grid<double> weighted = layout.fields[static_cast<std::size_t>(k)];
      for (std::size_t i = 0; i < weighted.size(); ++i) weighted.data()[i] *= weight.data()[i];
      const Vector all = layout.transpose(weighted);
      across.col(k) = all.head(local);
      own.col(k) += all.tail(count);
      solved.col(k) = factor.solve(across.col(k));
    }
    rest.compute(own - across.transpose() * solved);
  }

  Vector solve(const Vector& right) const {
    if (across.size() == 0) return factor.solve(right);
    const Eigen::Index local = across.rows(), count = across.cols();
    Vector out(local + count);
    const Vector first = factor.solve(right.head(local));
    out.tail(count) = rest.solve(right.tail(count) - across.transpose() * first);
    out.head(local) = first - solved * out.tail(count);
    return out;
  }

  /// What rows have in common with themselves and with the splines that reach into them.
  static void add_rows(const Layout& layout, const Grid<double>& weight, Matrix& matrix) {
    const std::size_t count = layout.parts.size() * per_part;
    std::vector<double> b(count);
    for (int y = 0; y < layout.height; ++y) {
      double own = 0;
      for (int x = 0; x < layout.width; ++x)
        own += weight(x, y) * std::pow(layout.row_jitter(x, y), 2);
      matrix.coeffRef(layout.first_row + y, layout.first_row + y) = own;
    }
    layout.for_each_cell([&](int x0, int y0, int x1, int y1, const std::vector<int>& numbers) {
      for (int y = y0; y < y1; ++y) {
        std::vector<double> sums(count);
        for (int x = x0; x < x1; ++x) {
          const double w = weight(x, y) * layout.row_jitter(x, y);
          if (w == 0) continue;
          layout.at(x, y, b.data());
          for (std::size_t i = 0; i < count; ++i) sums[i] += w * b[i];
        }
        for (std::size_t i = 0; i < count; ++i)
          matrix.coeffRef(layout.first_row + y, numbers[i]) += sums[i];
      }
    });
  }
};

Discrepancy::Factor::Factor(std::shared_ptr<const Layout> layout, const Grid<double>& weight)
    : layout_(std::move(layout)), weight_(weight), solver_(std::make_unique<Solver>()) {
  const std::size_t count = layout_->parts.size() * per_part;
  Matrix matrix = layout_->pattern;
  std::vector<double> b(count), sums(count * count);
  layout_->for_each_cell([&](int x0, int y0, int x1, int y1, const std::vector<int>& numbers) {
    std::ranges::fill(sums, 0.0);
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const double w = weight_(x, y);
        if (w == 0) continue;
        layout_->at(x, y, b.data());
        for (std::size_t i = 0; i < count; ++i) {
          const double wb = w * b[i];
          for (std::size_t k = 0; k < count; ++k) sums[i * count + k] += wb * b[k];
        }
      }
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < count; ++k)
        if (numbers[i] >= numbers[k])
          matrix.coeffRef(numbers[i], numbers[k]) += sums[i * count + k];
  });
  if (layout_->has_rows()) Solver::add_rows(*layout_, weight_, matrix);
  for (int k = 0; k < layout_->local; ++k) matrix.coeffRef(k, k) += 1;
  solver_->factor.compute(matrix);
  if (solver_->factor.info() != Eigen::Success)
    throw InvalidInput("SEM image", "its discrepancy cannot be solved for",
                       "Check `reconstruction.sem_noise`");
  solver_->add_fields(*layout_, weight_);
}

Discrepancy::Factor::~Factor() = default;

std::shared_ptr<const Discrepancy::Factor> Discrepancy::factor(const Grid<double>& weight) const {
  return std::make_shared<Factor>(layout_, weight);
}

Discrepancy::Factor::Fit Discrepancy::Factor::fit(const Grid<double>& residual) const {
  Grid<double> weighted = residual;
  for (std::size_t i = 0; i < weighted.size(); ++i) weighted.data()[i] *= weight_.data()[i];
  const Vector c = solver_->solve(layout_->transpose(weighted));
  return {layout_->field(c), 0.5 * c.squaredNorm(), {c.data(), c.data() + c.size()}};
}

Grid<double> Discrepancy::Factor::spread(const Grid<double>& v, const Fit& fit) const {
  Grid<double> out = layout_->field(
      solver_->solve(layout_->transpose(v) -
                     Eigen::Map<const Vector>(fit.coefficients.data(), layout_->coefficients)));
  for (std::size_t i = 0; i < out.size(); ++i) out.data()[i] *= weight_.data()[i];
  return out;
}

Grid<double> Discrepancy::Factor::precision(const Grid<double>& v) const {
  Grid<double> out = v;
  for (std::size_t i = 0; i < out.size(); ++i) out.data()[i] *= weight_.data()[i];
  const Grid<double> field = layout_->field(solver_->solve(layout_->transpose(out)));
  for (std::size_t i = 0; i < out.size(); ++i) out.data()[i] -= weight_.data()[i] * field.data()[i];
  return out;
}

std::vector<double> Discrepancy::Factor::rows_of(const Fit& fit) const {
  const auto first = fit.coefficients.begin() + layout_->first_row;
  return {first, first + (layout_->has_rows() ? layout_->height : 0)};
}

Grid<double> Discrepancy::Factor::draw(std::uint64_t seed, std::uint64_t stream) const {
  NormalNumbers normal(seed, stream);
  Vector c(layout_->coefficients);
  for (double& k : c) k = normal();
  return layout_->field(c);
}

}  // namespace surf::reconstruction
