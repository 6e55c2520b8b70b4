// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_factor.h"

#include <algorithm>
#include <limits>
#include <vector>

#include <cholmod.h>

#include "surf/core/error.h"

// OpenBLAS's own, which CHOLMOD's header does not bring.
extern "C" {
void openblas_set_num_threads(int count);
int openblas_get_num_threads();
int openblas_get_parallel();   // 0: built for one thread
}

namespace surf::reconstruction {

OneBlasThread::OneBlasThread() : before_(openblas_get_num_threads()) { openblas_set_num_threads(1); }
OneBlasThread::~OneBlasThread() { openblas_set_num_threads(before_); }
// Debian's serial build hands one buffer to all who call: factors come out wrong, or fail.
int OneBlasThread::most_at_once() { return openblas_get_parallel() == 0 ? 1 : std::numeric_limits<int>::max(); }

namespace {

/// Nested dissection: both halves first, then the two rows or columns between them, which is as far as the
/// stencil reaches. METIS finds no better one for a field, takes longer, and another one each time if two
/// threads ask at once.
void add_dissected(const Area& part, int width, std::vector<int>& order) {
  constexpr int reach = 2, small = 24;   // samples that are not cut any further
  const auto add = [&](const Area& a) {
    for (int y = a.y_begin; y < a.y_end; ++y)
      for (int x = a.x_begin; x < a.x_end; ++x) order.push_back(y * width + x);
  };
  if (part.samples() <= small || std::max(part.width(), part.height()) <= 2 * reach) return add(part);
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

}  // namespace

struct SparseFactor::Parts {
  cholmod_common common;
  cholmod_factor* factor = nullptr;
  cholmod_dense *x = nullptr, *y = nullptr, *e = nullptr;   // of solve, kept
  int width = 0, height = 0;

  Parts() {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_GIVEN;
    common.postorder = 1;
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;
  ~Parts() {
    cholmod_free_factor(&factor, &common);
    for (cholmod_dense** d : {&x, &y, &e}) cholmod_free_dense(d, &common);
    cholmod_finish(&common);
  }

  /// The system of that kind (see cholmod_solve) with this right side.
  Grid<double> solved(int system, const Grid<double>& right) {
    std::vector<double> numbers = right.data();
    cholmod_dense b{};
    b.nrow = b.d = b.nzmax = numbers.size();
    b.ncol = 1;
    b.x = numbers.data();
    b.xtype = CHOLMOD_REAL;
    b.dtype = CHOLMOD_DOUBLE;
    cholmod_solve2(system, factor, &b, nullptr, &x, nullptr, &y, &e, &common);
    Grid<double> out(width, height);
    std::copy_n(static_cast<const double*>(x->x), numbers.size(), out.data().begin());
    return out;
  }
};

SparseFactor::SparseFactor() : parts_(std::make_unique<Parts>()) {}
SparseFactor::~SparseFactor() = default;
SparseFactor::SparseFactor(SparseFactor&&) noexcept = default;

void SparseFactor::compute(const StencilMatrix& m, const Area& area) {
  const int n = area.samples();
  cholmod_common* common = &parts_->common;
  cholmod_sparse* a = cholmod_allocate_sparse(n, n, static_cast<std::size_t>(n) * StencilMatrix::slots, true, true, 1,
                                              CHOLMOD_REAL, common);
  if (!a) throw Error("reconstruct", "there is not enough memory for a surface of this size", "Cut the image");
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
  if (!parts_->factor) {
    std::vector<int> order;
    add_dissected({0, 0, area.width(), area.height()}, area.width(), order);
    parts_->factor = cholmod_analyze_p(a, order.data(), nullptr, 0, common);
  }
  cholmod_factorize(a, parts_->factor, common);
  cholmod_free_sparse(&a, common);
  if (common->status != CHOLMOD_OK)
    throw InvalidInput("reconstruct", "the surface is not determined", "Give an AFM image, or a stronger prior");
  parts_->width = area.width();
  parts_->height = area.height();
}

Grid<double> SparseFactor::solve(const Grid<double>& right) const { return parts_->solved(CHOLMOD_A, right); }

Grid<double> SparseFactor::draw(const Grid<double>& normal) const {
  // A = P^T L L^T P: L^-T turns white numbers into such of covariance (L L^T)^-1, P^T puts them back in
  // order.
  return parts_->solved(CHOLMOD_Pt, parts_->solved(CHOLMOD_Lt, normal));
}

}  // namespace surf::reconstruction
