// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_factor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cholmod_library.h"
#include "surf/core/error.h"

namespace surf::reconstruction {
namespace {

constexpr int most_refinements = 20;

double norm(const Grid<double>& a) {
  double sum = 0;
  for (const double v : a.data()) sum += v * v;
  return std::sqrt(sum);
}

}  // namespace

OneBlasThread::OneBlasThread() : before_(cholmod_library().blas_threads()) {
  cholmod_library().set_blas_threads(1);
}
OneBlasThread::~OneBlasThread() { cholmod_library().set_blas_threads(before_); }
// Debian's serial build gives the same buffer to all callers: factors would be wrong, or fail.
int OneBlasThread::most_at_once() {
  return cholmod_library().blas_is_parallel() == 0 ? 1 : std::numeric_limits<int>::max();
}

SparseFactor::SparseFactor(std::shared_ptr<const Dissection> order, Precision precision)
    : order_(std::move(order)), precision_(precision) {}
SparseFactor::~SparseFactor() = default;
SparseFactor::SparseFactor(SparseFactor&&) noexcept = default;

void SparseFactor::compute(std::shared_ptr<const StencilMatrix> matrix, const Area& area) {
  matrix_ = std::move(matrix);
  area_ = area;
  if (precision_ == Precision::single_where_it_holds) {
    if (!factor_ || !is_single_) factor_ = cholmod_library().make_single_factor(order_);
    is_single_ = true;
    if (factor_->compute(*matrix_, area_) && holds()) return;
  }
  compute_in_double();
}

void SparseFactor::compute_in_double() {
  if (!factor_ || is_single_) factor_ = cholmod_library().make_double_factor(order_);
  is_single_ = false;
  error_ = 0;
  if (!factor_->compute(*matrix_, area_))
    throw InvalidInput("reconstruct", "the surface is not determined",
                       "Give an AFM image, or a stronger prior");
}

/// Whether the factor finds a surface that is known, of long waves and a slope. These have the
/// smallest eigenvalues, and so what single precision loses first.
bool SparseFactor::holds() {
  Grid<double> known(area_.width(), area_.height()), right = known;
  for (int y = 0; y < known.height(); ++y)
    for (int x = 0; x < known.width(); ++x)
      known(x, y) = 1 + static_cast<double>(x - y) / (known.width() + known.height()) +
                    std::sin(0.05 * x + 1) * std::cos(0.07 * y);
  matrix_->subtract_product(area_, known, right);
  std::vector<Grid<double>> found{std::move(right)};
  factor_->solve(found);
  for (std::size_t i = 0; i < known.size(); ++i) found[0].data()[i] += known.data()[i];
  error_ = norm(found[0]) / norm(known);
  return error_ <= largest_error;  // false for NaN
}

/// Iterative refinement (Wilkinson 1963) with a coarse factor, until residuals no longer fall to
/// half. Returns whether they have then reached the rounding of double precision.
bool SparseFactor::refine(std::vector<Grid<double>>& x) const {
  const std::vector<Grid<double>> right = x;
  std::vector<Grid<double>> left = right;
  for (Grid<double>& one : x) std::fill(one.data().begin(), one.data().end(), 0.0);
  const double largest = matrix_->largest_row(area_);
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most_refinements; ++i) {
    factor_->solve(left);
    double most = 0;  // of residuals, in units of what they are summed from
    for (std::size_t k = 0; k < x.size(); ++k) {
      for (std::size_t p = 0; p < x[k].size(); ++p) x[k].data()[p] += left[k].data()[p];
      left[k] = right[k];
      matrix_->subtract_product(area_, x[k], left[k]);
      const double terms = largest * norm(x[k]) + norm(right[k]);
      if (terms > 0) most = std::max(most, norm(left[k]) / terms);
    }
    if (!(most < 0.5 * before)) return most < 4 * std::numeric_limits<double>::epsilon();
    before = most;
  }
  return false;
}

void SparseFactor::solve(std::vector<Grid<double>>& x) {
  if (is_single_) {
    std::vector<Grid<double>> refined = x;
    if (refine(refined)) {
      x = std::move(refined);
      return;
    }
    compute_in_double();
  }
  factor_->solve(x);
}
void SparseFactor::solve_coarsely(std::vector<Grid<double>>& x) const { factor_->solve(x); }
void SparseFactor::draw(std::vector<Grid<double>>& normal) const { factor_->draw(normal); }
std::size_t SparseFactor::bytes() const { return factor_->bytes(); }

}  // namespace surf::reconstruction
