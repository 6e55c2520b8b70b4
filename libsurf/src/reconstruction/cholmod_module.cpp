// SPDX-License-Identifier: GPL-3.0-or-later
#include <cholmod.h>

#include <algorithm>
#include <vector>

#include "cholmod_library.h"
#include "single_factor.h"
#include "surf/core/error.h"

// Functions of OpenBLAS that no header in Debian declares.
extern "C" {
void openblas_set_num_threads(int count);
int openblas_get_num_threads();
int openblas_get_parallel();
}

namespace surf::reconstruction {
namespace {

class CholmodFactor final : public Factor {
 public:
  explicit CholmodFactor(std::shared_ptr<const Dissection> order) : order_(std::move(order)) {
    cholmod_start(&common_);
    common_.print = 0;
    common_.supernodal = CHOLMOD_SUPERNODAL;
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_GIVEN;
    common_.postorder = 1;
  }
  CholmodFactor(const CholmodFactor&) = delete;
  CholmodFactor& operator=(const CholmodFactor&) = delete;
  ~CholmodFactor() override {
    cholmod_free_factor(&factor_, &common_);
    for (cholmod_dense** d : {&x_, &y_, &e_}) cholmod_free_dense(d, &common_);
    cholmod_finish(&common_);
  }

  bool compute(const StencilMatrix& matrix, const Area& area) override;
  void solve(std::vector<Grid<double>>& x) override { replace(CHOLMOD_A, x); }
  void draw(std::vector<Grid<double>>& x) override {
    // A = P^T L L^T P. L^-T gives white numbers the covariance (L L^T)^-1, and P^T restores their
    // order.
    for (const int system : {CHOLMOD_P, CHOLMOD_Lt, CHOLMOD_Pt}) replace(system, x);
  }
  std::size_t bytes() const override {
    return factor_ ? factor_->xsize * sizeof(double) + factor_->ssize * sizeof(int) : 0;
  }

 private:
  /// Replaces right sides by the solutions of the given kind of system (see cholmod_solve).
  void replace(int system, std::vector<Grid<double>>& x) {
    const std::size_t n = order_->samples();
    std::vector<double> numbers;
    for (const Grid<double>& one : x)
      numbers.insert(numbers.end(), one.data().begin(), one.data().end());
    cholmod_dense b{};
    b.nrow = b.d = n;
    b.ncol = x.size();
    b.nzmax = numbers.size();
    b.x = numbers.data();
    b.xtype = CHOLMOD_REAL;
    b.dtype = CHOLMOD_DOUBLE;
    cholmod_solve2(system, factor_, &b, nullptr, &x_, nullptr, &y_, &e_, &common_);
    for (std::size_t k = 0; k < x.size(); ++k)
      std::copy_n(static_cast<const double*>(x_->x) + k * n, n, x[k].data().begin());
  }

  std::shared_ptr<const Dissection> order_;
  cholmod_common common_;
  cholmod_factor* factor_ = nullptr;
  cholmod_dense *x_ = nullptr, *y_ = nullptr, *e_ = nullptr;  // workspace of solve, reused
};

bool CholmodFactor::compute(const StencilMatrix& m, const Area& area) {
  const int n = area.samples();
  cholmod_common* const with = &common_;
  cholmod_sparse* a = cholmod_allocate_sparse(
      n, n, static_cast<std::size_t>(n) * StencilMatrix::slots, true, true, 1, CHOLMOD_REAL, with);
  if (!a)
    throw Error("reconstruct", "there is not enough memory for a surface of this size",
                "Cut the image");
  auto* start = static_cast<int*>(a->p);
  auto* row = static_cast<int*>(a->i);
  auto* value = static_cast<double*>(a->x);
  int at = 0;
  for (int k = 0; k < n; ++k) {
    start[k] = at;
    m.for_each_in_column(area, k, [&](int r, double v) {
      row[at] = r;
      value[at++] = v;
    });
  }
  start[n] = at;
  if (!factor_) {
    std::vector<int> order = order_->sample;
    factor_ = cholmod_analyze_p(a, order.data(), nullptr, 0, with);
  }
  cholmod_factorize(a, factor_, with);
  cholmod_free_sparse(&a, with);
  return with->status == CHOLMOD_OK;
}

std::unique_ptr<Factor> make_double_factor(std::shared_ptr<const Dissection> order) {
  return std::make_unique<CholmodFactor>(std::move(order));
}

constexpr CholmodLibrary table{make_double_factor, make_single_factor, openblas_set_num_threads,
                               openblas_get_num_threads, openblas_get_parallel};

}  // namespace
}  // namespace surf::reconstruction

SEMSURF_MODULE(cholmod, surf::reconstruction::table)
