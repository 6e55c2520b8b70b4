// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_factor.h"

#include <limits>

#include "cholmod_library.h"

namespace surf::reconstruction {

OneBlasThread::OneBlasThread() : before_(cholmod_library().blas_threads()) {
  cholmod_library().set_blas_threads(1);
}
OneBlasThread::~OneBlasThread() { cholmod_library().set_blas_threads(before_); }
// Debian's serial build gives the same buffer to all callers: factors would be wrong, or fail.
int OneBlasThread::most_at_once() {
  return cholmod_library().blas_is_parallel() == 0 ? 1 : std::numeric_limits<int>::max();
}

SparseFactor::SparseFactor() : factor_(cholmod_library().make_factor()) {}
SparseFactor::~SparseFactor() = default;
SparseFactor::SparseFactor(SparseFactor&&) noexcept = default;

void SparseFactor::compute(const StencilMatrix& matrix, const Area& area) {
  factor_->compute(matrix, area);
}
Grid<double> SparseFactor::solve(const Grid<double>& right) const { return factor_->solve(right); }
Grid<double> SparseFactor::draw(const Grid<double>& normal) const { return factor_->draw(normal); }

}  // namespace surf::reconstruction
