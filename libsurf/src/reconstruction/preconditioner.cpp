// SPDX-License-Identifier: GPL-3.0-or-later
#include "preconditioner.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>

namespace surf::reconstruction {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// Lower triangles of a 5 x 5 stencil, gathered row by row: coefficient of (x, y) with (x + dx, y + dy), of
/// which half the 25 come later in row-major order.
class StencilMatrix {
 public:
  StencilMatrix(int width, int height) : width_(width), values_(static_cast<std::size_t>(width) * height * slots) {}

  void add(int x0, int y0, int x1, int y1, double v) {
    if (y1 < y0 || (y1 == y0 && x1 < x0)) {
      std::swap(x0, x1);
      std::swap(y0, y1);
    }
    values_[(static_cast<std::size_t>(y0) * width_ + x0) * slots + (y1 - y0) * 5 + (x1 - x0) + 2] += v;
  }

  Matrix matrix() const {
    const int n = static_cast<int>(values_.size() / slots);
    Matrix m(n, n);
    std::vector<int> counts(n);
    for (int k = 0; k < n; ++k)
      counts[k] = static_cast<int>(std::count_if(&values_[std::size_t(k) * slots], &values_[std::size_t(k) * slots] + slots,
                                                 [](double v) { return v != 0; }));
    m.reserve(counts);
    for (int k = 0; k < n; ++k)
      for (int s = 2; s < slots; ++s) {
        const double v = values_[static_cast<std::size_t>(k) * slots + s];
        if (v != 0) m.insert(k + (s / 5) * width_ + s % 5 - 2, k) = v;
      }
    m.makeCompressed();
    return m;
  }

 private:
  static constexpr int slots = 15;   // rows dy = 0, 1, 2 of dx = -2 .. 2; the first two never come
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
  Eigen::SimplicialLLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<int>> heights;
  Eigen::Index nonzeros = -1;
  Eigen::LDLT<Eigen::MatrixXd> map, mixture;
  int width = 0, height = 0;
  bool has_map = false, has_mixture = false;
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
  const Matrix matrix = m.matrix();
  if (matrix.nonZeros() != parts_->nonzeros) parts_->heights.analyzePattern(matrix);
  parts_->nonzeros = matrix.nonZeros();
  parts_->heights.factorize(matrix);

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
  const Eigen::Map<const Eigen::VectorXd> z(r.z_nm.data().data(), static_cast<Eigen::Index>(r.z_nm.size()));
  out.z_nm = Grid<double>(parts_->width, parts_->height);
  Eigen::Map<Eigen::VectorXd>(out.z_nm.data().data(), z.size()) = parts_->heights.solve(z);
  if (parts_->has_map)
    Eigen::Map<Eigen::VectorXd>(out.map.data(), map_numbers) =
        parts_->map.solve(Eigen::Map<const Eigen::VectorXd>(r.map.data(), map_numbers));
  out.mixture.assign(r.mixture.size(), 0);
  if (parts_->has_mixture)
    Eigen::Map<Eigen::VectorXd>(out.mixture.data(), static_cast<Eigen::Index>(r.mixture.size())) =
        parts_->mixture.solve(Eigen::Map<const Eigen::VectorXd>(r.mixture.data(), static_cast<Eigen::Index>(r.mixture.size())));
  return out;
}

}  // namespace surf::reconstruction
