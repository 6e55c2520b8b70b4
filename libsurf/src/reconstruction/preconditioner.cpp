// SPDX-License-Identifier: GPL-3.0-or-later
#include "preconditioner.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <cholmod.h>

#include "surf/core/error.h"

namespace surf::reconstruction {
namespace {

/// Upper triangles of a 5 x 5 stencil, gathered row by row: coefficients of (x, y) with those before it in row-major
/// order, and with itself.
class StencilMatrix {
 public:
  StencilMatrix(int width, int height) : width_(width), values_(static_cast<std::size_t>(width) * height * slots) {}

  void add(int x0, int y0, int x1, int y1, double v) {
    if (y1 > y0 || (y1 == y0 && x1 > x0)) {
      std::swap(x0, x1);
      std::swap(y0, y1);
    }
    values_[(static_cast<std::size_t>(y0) * width_ + x0) * slots + (y1 - y0 + 2) * 5 + (x1 - x0) + 2] += v;
  }

  int samples() const { return static_cast<int>(values_.size() / slots); }

  /// Calls entry(row, value) for the column's entries, rows rising, the diagonal last. All that lie in the field
  /// are there, so that the pattern does not depend on the values.
  template <class Entry>
  void for_each_in_column(int k, const Entry& entry) const {
    const int x = k % width_, y = k / width_;
    for (int s = 0; s < slots; ++s) {
      const int u = x + s % 5 - 2, v = y + s / 5 - 2;
      if (u < 0 || u >= width_ || v < 0) continue;
      entry(v * width_ + u, values_[static_cast<std::size_t>(k) * slots + s]);
    }
  }

 private:
  static constexpr int slots = 13;   // two rows of five before, and three of its own
  int width_;
  std::vector<double> values_;
};

/// Bilinear weights of a place, inside the samples.
struct Corners {
  int x, y;
  double w[4];
  Corners(const Contact& c, int width, int height) {
    x = std::clamp(static_cast<int>(c.x), 0, width - 2);
    y = std::clamp(static_cast<int>(c.y), 0, height - 2);
    const double tx = c.x - x, ty = c.y - y;
    w[0] = (1 - tx) * (1 - ty);
    w[1] = tx * (1 - ty);
    w[2] = (1 - tx) * ty;
    w[3] = tx * ty;
  }
};

}  // namespace

struct Preconditioner::Parts {
  cholmod_common common;
  cholmod_factor* factor = nullptr;
  cholmod_dense *x = nullptr, *y = nullptr, *e = nullptr;   // of solve, kept
  Eigen::LDLT<Eigen::MatrixXd> map, mixture;
  int width = 0, height = 0;
  bool has_map = false, has_mixture = false;

  Parts() {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
    // Nested dissection first: a field's factor is a third smaller than with minimum degree.
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_METIS;
    common.postorder = 1;
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;
  ~Parts() {
    cholmod_free_factor(&factor, &common);
    for (cholmod_dense** d : {&x, &y, &e}) cholmod_free_dense(d, &common);
    cholmod_finish(&common);
  }

  void compute(const StencilMatrix& m) {
    const int n = m.samples();
    cholmod_sparse* a = cholmod_allocate_sparse(n, n, static_cast<std::size_t>(n) * 13, true, true, 1, CHOLMOD_REAL, &common);
    if (!a) throw Error("reconstruct", "there is not enough memory for a surface of this size", "Cut the image");
    auto* start = static_cast<int*>(a->p);
    auto* row = static_cast<int*>(a->i);
    auto* value = static_cast<double*>(a->x);
    int at = 0;
    for (int k = 0; k < n; ++k) {
      start[k] = at;
      m.for_each_in_column(k, [&](int r, double v) {
        row[at] = r;
        value[at++] = v;
      });
    }
    start[n] = at;
    if (!factor) factor = cholmod_analyze(a, &common);
    cholmod_factorize(a, factor, &common);
    cholmod_free_sparse(&a, &common);
    if (common.status != CHOLMOD_OK)
      throw InvalidInput("reconstruct", "the surface is not determined", "Give an AFM image, or a stronger prior");
  }
};

Preconditioner::Preconditioner() : parts_(std::make_unique<Parts>()) {}
Preconditioner::~Preconditioner() = default;

void Preconditioner::factor(const Objective& o, const Unknowns& at, const Objective::State& s) {
  const int w = o.frame.width, h = o.frame.height;
  parts_->width = w;
  parts_->height = h;
  StencilMatrix m(w, h);
  o.prior.for_each_difference(s.prior_weights, [&](int x, int y, int count, const int* dx, const int* dy, const double* c,
                                                   double weight) {
    for (int a = 0; a < count; ++a)
      for (int b = a; b < count; ++b) m.add(x + dx[a], y + dy[a], x + dx[b], y + dy[b], weight * c[a] * c[b]);
  });
  double largest = 0;
  for (const double p : s.prior_weights.data()) largest = std::max(largest, p);
  const double ground = o.anchor_per_nm2 + 1e-12 * largest * std::pow(o.frame.pitch_nm, -4);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) m.add(x, y, x, y, ground);
  parts_->has_map = o.afm && o.fit_map;
  if (o.afm) {
    const double q = (1 - o.afm->noise().alpha * o.afm->noise().alpha) / o.afm->noise().innovation_nm2;
    for (const Contact& c : s.afm->contacts) {
      if (!c.inside) continue;
      const Corners k(c, w, h);
      for (int a = 0; a < 4; ++a)
        for (int b = a; b < 4; ++b)
          m.add(k.x + a % 2, k.y + a / 2, k.x + b % 2, k.y + b / 2, q * k.w[a] * k.w[b]);
    }
  }
  parts_->compute(m);

  // Map and mixture: their own blocks.
  if (parts_->has_map) {
    Eigen::MatrixXd block(map_numbers, map_numbers);
    for (int k = 0; k < map_numbers; ++k) {
      MapChange unit{};
      unit[k] = 1;
      const Grid<double> none(w, h);
      Grid<double> unused(w, h);
      MapChange column{};
      o.afm->add_gradient(*s.afm, at.z_nm, o.afm->precision(o.afm->change(*s.afm, at.z_nm, none, unit)), unused, &column);
      for (int i = 0; i < map_numbers; ++i) block(i, k) = column[i];
    }
    block = 0.5 * (block + block.transpose()).eval();
    block.diagonal().array() *= 1 + 1e-9;
    block.diagonal().array() += 1e-12;
    parts_->map.compute(block);
  }
  parts_->has_mixture = o.sem && o.fit_mixture;
  if (parts_->has_mixture) {
    const std::size_t n = o.sem->channels() + 1;
    Eigen::MatrixXd block = Eigen::MatrixXd::Zero(n, n);
    const auto column = [&](std::size_t c, std::size_t i) {
      return c + 1 < n ? s.sem->linear->images()[c].data()[i] : 1.0;
    };
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = a; b < n; ++b) {
        double sum = 0;
        for (std::size_t i = 0; i < s.sem->information.size(); ++i)
          sum += s.sem->information.data()[i] * column(a, i) * column(b, i);
        block(a, b) = block(b, a) = sum;
      }
    block.diagonal().array() *= 1 + 1e-9;
    parts_->mixture.compute(block);
  }
}

Step Preconditioner::solve(const Step& r) const {
  Step out;
  std::vector<double> right = r.z_nm.data();
  cholmod_dense b{};
  b.nrow = b.d = b.nzmax = right.size();
  b.ncol = 1;
  b.x = right.data();
  b.xtype = CHOLMOD_REAL;
  b.dtype = CHOLMOD_DOUBLE;
  cholmod_solve2(CHOLMOD_A, parts_->factor, &b, nullptr, &parts_->x, nullptr, &parts_->y, &parts_->e, &parts_->common);
  out.z_nm = Grid<double>(parts_->width, parts_->height);
  const auto* const x = static_cast<const double*>(parts_->x->x);
  std::copy(x, x + right.size(), out.z_nm.data().begin());
  if (parts_->has_map)
    Eigen::Map<Eigen::VectorXd>(out.map.data(), map_numbers) =
        parts_->map.solve(Eigen::Map<const Eigen::VectorXd>(r.map.data(), map_numbers));
  out.mixture.assign(r.mixture.size(), 0);
  if (parts_->has_mixture)
    Eigen::Map<Eigen::VectorXd>(out.mixture.data(), static_cast<Eigen::Index>(r.mixture.size())) =
        parts_->mixture.solve(Eigen::Map<const Eigen::VectorXd>(r.mixture.data(), static_cast<Eigen::Index>(r.mixture.size())));
  return out;
}

Grid<double> Preconditioner::variances_nm2() const {
  // Column by column, the diagonal first.
  cholmod_factor* f = cholmod_copy_factor(parts_->factor, &parts_->common);
  cholmod_change_factor(CHOLMOD_REAL, true, false, true, true, f, &parts_->common);
  const int n = static_cast<int>(f->n);
  const auto* const start = static_cast<const int*>(f->p);
  const auto* const row = static_cast<const int*>(f->i);
  const auto* const l = static_cast<const double*>(f->x);
  std::vector<double> z(static_cast<std::size_t>(start[n]));   // the inverse, where L has entries
  std::vector<int> place(n, -1);   // of a row among the column's entries
  for (int j = n - 1; j >= 0; --j) {
    const int begin = start[j], end = start[j + 1];
    for (int e = begin; e < end; ++e) place[row[e]] = e;
    // z_ij = - sum over k of l_kj / l_jj z_ik, over the entries k below the diagonal; z_ik is in column min(i, k).
    for (int e = begin + 1; e < end; ++e) {
      const int k = row[e];
      const double share = l[e] / l[begin];
      for (int s = start[k]; s < start[k + 1]; ++s) {
        const int at = place[row[s]];
        if (at < 0) continue;
        z[at] -= share * z[s];
        if (at != e) z[e] -= l[at] / l[begin] * z[s];
      }
    }
    double diagonal = 1 / (l[begin] * l[begin]);
    for (int e = begin + 1; e < end; ++e) diagonal -= l[e] / l[begin] * z[e];
    z[begin] = diagonal;
    for (int e = begin; e < end; ++e) place[row[e]] = -1;
  }
  Grid<double> out(parts_->width, parts_->height);
  const auto* const order = static_cast<const int*>(f->Perm);   // of the factor's rows
  for (int i = 0; i < n; ++i) out.data()[order[i]] = z[start[i]];
  cholmod_free_factor(&f, &parts_->common);
  return out;
}

}  // namespace surf::reconstruction
