// SPDX-License-Identifier: GPL-3.0-or-later
#include "afm/cholesky.h"

#include <Eigen/Cholesky>

namespace surf {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace

bool solve_cholesky(std::vector<double>& a, std::vector<double>& b) {
  const auto n = static_cast<Eigen::Index>(b.size());
  Eigen::Map<Matrix> matrix(a.data(), n, n);
  const Eigen::VectorXd before = matrix.diagonal();
  Eigen::Ref<Matrix> in_place(matrix);
  if (Eigen::LLT<Eigen::Ref<Matrix>>(in_place).info() != Eigen::Success) return false;
  // Compares what remains of each column after the elimination of the columns before it.
  if (!(matrix.diagonal().array().square() > 1e-10 * before.array()).all()) return false;
  solve_factored(a, b);
  return true;
}

void solve_factored(const std::vector<double>& a, std::vector<double>& b) {
  const auto n = static_cast<Eigen::Index>(b.size());
  const Eigen::Map<const Matrix> matrix(a.data(), n, n);
  Eigen::Map<Eigen::VectorXd> x(b.data(), n);
  const auto factor = matrix.triangularView<Eigen::Lower>();
  factor.solveInPlace(x);
  factor.transpose().solveInPlace(x);
}

}  // namespace surf
