// SPDX-License-Identifier: GPL-3.0-or-later
#include "preconditioner.h"

#include <algorithm>
#include <array>
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

double product(const Grid<double>& a, const Grid<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a.data()[i] * b.data()[i];
  return sum;
}

}  // namespace

struct Preconditioner::Parts {
  cholmod_common common;
  cholmod_factor* factor = nullptr;
  cholmod_dense *x = nullptr, *y = nullptr, *e = nullptr;   // of solve, kept
  Eigen::LDLT<Eigen::MatrixXd> map, mixture, tip;
  int width = 0, height = 0;
  std::array<Grid<double>, tip_numbers> follows;   // how the surface gives way to the tip
  bool has_map = false, has_mixture = false, has_tip = false;

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
  // The tip with the surface: what one takes off a contact the other can give back, so that its own block alone would leave a
  // long valley. Eliminated exactly, with the contacts as above.
  parts_->has_tip = o.afm && o.fit_tip;
  if (parts_->has_tip) {
    const double q = (1 - o.afm->noise().alpha * o.afm->noise().alpha) / o.afm->noise().innovation_nm2;
    Eigen::MatrixXd block = o.tip_precision * Eigen::MatrixXd::Identity(tip_numbers, tip_numbers);
    std::array<Grid<double>, tip_numbers> coupling;
    coupling.fill(Grid<double>(w, h));
    for (const Contact& c : s.afm->contacts) {
      if (c.tip_sample < 0) continue;
      const TipChange& d = s.afm->by_tip[c.tip_sample];
      for (int i = 0; i < tip_numbers; ++i)
        for (int k = 0; k < tip_numbers; ++k) block(i, k) += q * d[i] * d[k];
      if (!c.inside) continue;
      const Corners at_surface(c, w, h);
      for (int k = 0; k < tip_numbers; ++k)
        for (int a = 0; a < 4; ++a) coupling[k](at_surface.x + a % 2, at_surface.y + a / 2) += q * at_surface.w[a] * d[k];
    }
    for (int k = 0; k < tip_numbers; ++k) parts_->follows[k] = parts_->solved(CHOLMOD_A, coupling[k]);
    for (int i = 0; i < tip_numbers; ++i)
      for (int k = 0; k < tip_numbers; ++k) block(i, k) -= product(coupling[i], parts_->follows[k]);
    block = 0.5 * (block + block.transpose()).eval();
    parts_->tip.compute(block);
  }
  parts_->has_mixture = o.sem && o.fit_mixture;
  if (parts_->has_mixture) {
    Eigen::MatrixXd block = Eigen::MatrixXd::Zero(2, 2);
    for (std::size_t i = 0; i < s.sem->information.size(); ++i) {
      const double q = s.sem->information.data()[i], gain = s.sem->simulated.data()[i] - at.mixture.back();
      block(0, 0) += q * gain * gain;
      block(0, 1) += q * gain;
      block(1, 1) += q;
    }
    block(1, 0) = block(0, 1);
    block.diagonal().array() *= 1 + 1e-9;
    parts_->mixture.compute(block);
  }
}

Step Preconditioner::solve(const Step& r) const {
  Step out;
  out.z_nm = parts_->solved(CHOLMOD_A, r.z_nm);
  if (parts_->has_map)
    Eigen::Map<Eigen::VectorXd>(out.map.data(), map_numbers) =
        parts_->map.solve(Eigen::Map<const Eigen::VectorXd>(r.map.data(), map_numbers));
  if (parts_->has_mixture)
    Eigen::Map<Eigen::Vector2d>(out.mixture.data()) =
        parts_->mixture.solve(Eigen::Map<const Eigen::Vector2d>(r.mixture.data()));
  if (parts_->has_tip) {
    Eigen::VectorXd right = Eigen::Map<const Eigen::VectorXd>(r.tip.data(), tip_numbers);
    for (int k = 0; k < tip_numbers; ++k) right(k) -= product(parts_->follows[k], r.z_nm);
    const Eigen::VectorXd tip = parts_->tip.solve(right);
    for (int k = 0; k < tip_numbers; ++k) {
      out.tip[k] = tip(k);
      for (std::size_t i = 0; i < out.z_nm.size(); ++i) out.z_nm.data()[i] -= tip(k) * parts_->follows[k].data()[i];
    }
  }
  return out;
}

Grid<double> Preconditioner::draw_nm(const Grid<double>& normal) const {
  // A = P^T L L^T P: L^-T turns white numbers into such of covariance (L L^T)^-1, P^T puts them back in order.
  const Grid<double> turned = parts_->solved(CHOLMOD_Lt, normal);
  return parts_->solved(CHOLMOD_Pt, turned);
}

}  // namespace surf::reconstruction
