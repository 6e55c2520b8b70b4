// SPDX-License-Identifier: GPL-3.0-or-later
#include <cholmod.h>

#include <algorithm>
#include <vector>

#include "cholmod_library.h"
#include "surf/core/error.h"

// Functions of OpenBLAS that no header in Debian declares.
extern "C" {
void openblas_set_num_threads(int count);
int openblas_get_num_threads();
int openblas_get_parallel();
}

namespace surf::reconstruction {
namespace {

/// Nested dissection: both halves first, then the two rows or columns between them, which is the
/// reach of the stencil. METIS finds no better order for a field, takes longer, and gives different
/// orders if two threads call it at once.
void add_dissected(const Area& part, int width, std::vector<int>& order) {
  constexpr int reach = 2, small = 24;  // parts of at most this side are not divided
  const auto add = [&](const Area& a) {
    for (int y = a.y_begin; y < a.y_end; ++y)
      for (int x = a.x_begin; x < a.x_end; ++x) order.push_back(y * width + x);
  };
  if (part.samples() <= small || std::max(part.width(), part.height()) <= 2 * reach)
    return add(part);
  Area before = part, between = part, after = part;
  if (part.width() >= part.height()) {
    before.x_end = between.x_begin = part.x_begin + (part.width() - reach) / 2;
    between.x_end = after.x_begin = between.x_begin + reach;
  } else {
    before.y_end = between.y_begin = part.y_begin + (part.height() - reach) / 2;
    between.y_end = after.y_begin = between.y_begin + reach;
  }
  add_dissected(before, width, order);
  add_dissected(after, width, order);
  add(between);
}

class CholmodFactor final : public Factor {
 public:
  CholmodFactor() {
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

  void compute(const StencilMatrix& m, const Area& area) override;
  Grid<double> solve(const Grid<double>& right) override { return solved(CHOLMOD_A, right); }
  Grid<double> draw(const Grid<double>& normal) override {
    // A = P^T L L^T P. L^-T gives white numbers the covariance (L L^T)^-1, and P^T restores their
    // order.
    return solved(CHOLMOD_Pt, solved(CHOLMOD_Lt, normal));
  }

 private:
  /// Solves the given kind of system (see cholmod_solve) for this right side.
  Grid<double> solved(int system, const Grid<double>& right) {
    std::vector<double> numbers = right.data();
    cholmod_dense b{};
    b.nrow = b.d = b.nzmax = numbers.size();
    b.ncol = 1;
    b.x = numbers.data();
    b.xtype = CHOLMOD_REAL;
    b.dtype = CHOLMOD_DOUBLE;
    cholmod_solve2(system, factor_, &b, nullptr, &x_, nullptr, &y_, &e_, &common_);
    Grid<double> out(width_, height_);
    std::copy_n(static_cast<const double*>(x_->x), numbers.size(), out.data().begin());
    return out;
  }

  cholmod_common common_;
  cholmod_factor* factor_ = nullptr;
  cholmod_dense *x_ = nullptr, *y_ = nullptr, *e_ = nullptr;  // workspace of solve, reused
  int width_ = 0, height_ = 0;
};

void CholmodFactor::compute(const StencilMatrix& m, const Area& area) {
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
    std::vector<int> order;
    add_dissected({0, 0, area.width(), area.height()}, area.width(), order);
    factor_ = cholmod_analyze_p(a, order.data(), nullptr, 0, with);
  }
  cholmod_factorize(a, factor_, with);
  cholmod_free_sparse(&a, with);
  if (with->status != CHOLMOD_OK)
    throw InvalidInput("reconstruct", "the surface is not determined",
                       "Give an AFM image, or a stronger prior");
  width_ = area.width();
  height_ = area.height();
}

std::unique_ptr<Factor> make_factor() { return std::make_unique<CholmodFactor>(); }

constexpr CholmodLibrary table{make_factor, openblas_set_num_threads, openblas_get_num_threads,
                               openblas_get_parallel};

}  // namespace
}  // namespace surf::reconstruction

SEMSURF_MODULE(cholmod, surf::reconstruction::table)
