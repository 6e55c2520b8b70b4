// SPDX-License-Identifier: GPL-3.0-or-later
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reconstruction/single_factor.cpp"
#include "core/each_target.h"

HWY_BEFORE_NAMESPACE();
namespace surf::reconstruction::HWY_NAMESPACE {

typedef float Floats __attribute__((vector_size(SEMSURF_VECTOR_BYTES), aligned(4), may_alias));
constexpr int lanes = SEMSURF_VECTOR_BYTES / sizeof(float);

inline const Floats& at(const float* p) { return *reinterpret_cast<const Floats*>(p); }
inline Floats& at(float* p) { return *reinterpret_cast<Floats*>(p); }

inline float sum(const Floats& v) {
  float part[lanes];
  for (int i = 0; i < lanes; ++i) part[i] = v[i];
  for (int half = lanes / 2; half > 0; half /= 2)
    for (int i = 0; i < half; ++i) part[i] += part[i + half];
  return part[0];
}

/// Solves with the triangle of a front's panel for the first `own` numbers of v, and subtracts what
/// the rows below give with these from the rest. Works on whole vectors: reads up to `read_beyond`
/// numbers behind a column, and writes as many behind v.
void eliminate(const float* panel, int rows, int own, float* v) {
  int j = 0;
  for (; j + 4 <= own; j += 4) {
    const float *c0 = panel + static_cast<std::ptrdiff_t>(j) * rows, *c1 = c0 + rows,
                *c2 = c1 + rows, *c3 = c2 + rows;
    const float x0 = v[j] * c0[j], x1 = (v[j + 1] - c0[j + 1] * x0) * c1[j + 1],
                x2 = (v[j + 2] - c0[j + 2] * x0 - c1[j + 2] * x1) * c2[j + 2],
                x3 = (v[j + 3] - c0[j + 3] * x0 - c1[j + 3] * x1 - c2[j + 3] * x2) * c3[j + 3];
    v[j] = x0;
    v[j + 1] = x1;
    v[j + 2] = x2;
    v[j + 3] = x3;
    for (int i = j + 4; i < rows; i += lanes)
      at(v + i) -= at(c0 + i) * x0 + at(c1 + i) * x1 + at(c2 + i) * x2 + at(c3 + i) * x3;
  }
  for (; j < own; ++j) {
    const float* c = panel + static_cast<std::ptrdiff_t>(j) * rows;
    const float x = v[j] * c[j];
    v[j] = x;
    for (int i = j + 1; i < rows; i += lanes) at(v + i) -= at(c + i) * x;
  }
}

/// The transpose: subtracts from the first `own` numbers of v what the rows below give with the
/// rest, and solves with the transposed triangle. `read_beyond` zeros stand behind v.
void substitute(const float* panel, int rows, int own, float* v) {
  int j = own;
  while (j % 4 != 0) {
    const float* c = panel + static_cast<std::ptrdiff_t>(--j) * rows;
    Floats s = {};
    for (int i = j + 1; i < rows; i += lanes) s += at(c + i) * at(v + i);
    v[j] = (v[j] - sum(s)) * c[j];
  }
  while (j > 0) {
    j -= 4;
    const float *c0 = panel + static_cast<std::ptrdiff_t>(j) * rows, *c1 = c0 + rows,
                *c2 = c1 + rows, *c3 = c2 + rows;
    Floats s0 = {}, s1 = {}, s2 = {}, s3 = {};
    for (int i = j + 4; i < rows; i += lanes) {
      const Floats x = at(v + i);
      s0 += at(c0 + i) * x;
      s1 += at(c1 + i) * x;
      s2 += at(c2 + i) * x;
      s3 += at(c3 + i) * x;
    }
    const float x3 = (v[j + 3] - sum(s3)) * c3[j + 3],
                x2 = (v[j + 2] - sum(s2) - c2[j + 3] * x3) * c2[j + 2],
                x1 = (v[j + 1] - sum(s1) - c1[j + 2] * x2 - c1[j + 3] * x3) * c1[j + 1];
    v[j] = (v[j] - sum(s0) - c0[j + 1] * x1 - c0[j + 2] * x2 - c0[j + 3] * x3) * c0[j];
    v[j + 1] = x1;
    v[j + 2] = x2;
    v[j + 3] = x3;
  }
}

}  // namespace surf::reconstruction::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "single_factor.h"

#include <algorithm>
#include <cmath>

// Functions of OpenBLAS. Matrices lie column by column.
extern "C" {
void spotrf_(const char* uplo, const int* n, float* a, const int* lda, int* info);
void strsm_(const char* side, const char* uplo, const char* trans, const char* diag, const int* m,
            const int* n, const float* alpha, const float* a, const int* lda, float* b,
            const int* ldb);
void ssyrk_(const char* uplo, const char* trans, const int* n, const int* k, const float* alpha,
            const float* a, const int* lda, const float* beta, float* c, const int* ldc);
}

namespace surf::reconstruction {
namespace {

constexpr float one = 1, minus_one = -1;
constexpr int read_beyond = 16;  // the numbers in the longest vector

HWY_EXPORT(eliminate);
HWY_EXPORT(substitute);

class SingleFactor final : public Factor {
 public:
  explicit SingleFactor(std::shared_ptr<const Dissection> order) : order_(std::move(order)) {
    std::size_t size = 0;
    for (const Front& f : order_->fronts) {
      begin_.push_back(size);
      size += static_cast<std::size_t>(f.rows()) * f.own;
      most_rows_ = std::max(most_rows_, f.rows());
    }
    panels_.resize(size + read_beyond);
    column_.resize(most_rows_ + read_beyond);
    scale_.resize(order_->samples());
  }

  bool compute(const StencilMatrix& matrix, const Area& area) override;
  void solve(std::vector<Grid<double>>& x) override { run(x, true); }
  void draw(std::vector<Grid<double>>& x) override { run(x, false); }
  std::size_t bytes() const override { return sizeof(float) * (panels_.size() + scale_.size()); }

 private:
  /// What is left of a front for its parent: the lower triangle of a square matrix.
  using Rest = std::vector<float>;

  bool scale(const StencilMatrix& matrix, const Area& area);
  void add_matrix(const StencilMatrix& matrix, const Area& area, const Front& f,
                  std::vector<int>& row_of, float* panel) const;
  static void add_rest(const Front& child, const Rest& from, const Front& f, float* panel,
                       Rest& to);
  void run(std::vector<Grid<double>>& x, bool forward);
  void forward(std::size_t front, float* x);
  void backward(std::size_t front, float* x);

  std::shared_ptr<const Dissection> order_;
  /// The columns of each front, with all its rows. The strict upper triangle is not used, and the
  /// diagonal holds reciprocals.
  std::vector<float> panels_;
  std::vector<std::size_t> begin_;  // of each front's panel
  std::vector<float> scale_;        // of each place: the matrix times these has a diagonal of 1
  int most_rows_ = 0;
  std::vector<float> x_, column_;  // workspace of solutions
};

bool SingleFactor::scale(const StencilMatrix& matrix, const Area& area) {
  for (int e = 0; e < order_->samples(); ++e) {
    const int x = order_->sample[e] % order_->width, y = order_->sample[e] / order_->width;
    const double d = matrix.at(x + area.x_begin, y + area.y_begin, StencilMatrix::slots - 1);
    if (!(d > 0) || !std::isfinite(d)) return false;
    scale_[e] = static_cast<float>(1 / std::sqrt(d));
    if (!(scale_[e] > 0) || !std::isfinite(scale_[e])) return false;
  }
  return true;
}

void SingleFactor::add_matrix(const StencilMatrix& matrix, const Area& area, const Front& f,
                              std::vector<int>& row_of, float* panel) const {
  const int rows = f.rows(), w = order_->width, h = order_->height;
  for (int i = 0; i < rows - f.own; ++i) row_of[f.border[i]] = f.own + i;
  for (int j = 0; j < f.own; ++j) row_of[f.first + j] = j;
  for (int j = 0; j < f.own; ++j) {
    const int here = f.first + j, x = order_->sample[here] % w, y = order_->sample[here] / w;
    const auto add = [&](int u, int v, double value) {
      if (u < 0 || u >= w || v < 0 || v >= h) return;
      const int there = order_->place[v * w + u];
      if (there < here) return;  // it belongs to the other's column
      panel[static_cast<std::size_t>(j) * rows + row_of[there]] +=
          static_cast<float>(value * scale_[here] * scale_[there]);
    };
    for (int s = 0; s < StencilMatrix::slots; ++s) {
      const auto [dx, dy] = StencilMatrix::offsets[s];
      add(x + dx, y + dy, matrix.at(x + area.x_begin, y + area.y_begin, s));
      const int u = x - dx, v = y - dy;  // the later sample of the pair
      if (s + 1 < StencilMatrix::slots && u >= 0 && u < w && v < h)
        add(u, v, matrix.at(u + area.x_begin, v + area.y_begin, s));
    }
  }
}

void SingleFactor::add_rest(const Front& child, const Rest& from, const Front& f, float* panel,
                            Rest& to) {
  const int n = static_cast<int>(child.border.size()), rows = f.rows(), left = rows - f.own;
  for (int k = 0; k < n; ++k) {
    const int column = child.in_parent[k];
    // Places rise in the child and in the parent, so the lower triangle stays one.
    float* const out = column < f.own
                           ? panel + static_cast<std::size_t>(column) * rows
                           : to.data() + static_cast<std::size_t>(column - f.own) * left - f.own;
    const float* const in = from.data() + static_cast<std::size_t>(k) * n;
    for (int i = k; i < n; ++i) out[child.in_parent[i]] += in[i];
  }
}

bool SingleFactor::compute(const StencilMatrix& matrix, const Area& area) {
  if (!scale(matrix, area)) return false;
  std::fill(panels_.begin(), panels_.end(), 0.F);
  std::vector<int> row_of(order_->samples());
  // Fronts come depth first: what is left of children waits at the end of their depth's list.
  int deepest = 0;
  for (const Front& f : order_->fronts) deepest = std::max(deepest, f.depth);
  struct Waiting {
    Rest rest;
    const Front* from = nullptr;
  };
  std::vector<Waiting> waiting(2 * (deepest + 2));
  for (std::size_t i = 0; i < order_->fronts.size(); ++i) {
    const Front& f = order_->fronts[i];
    float* const panel = panels_.data() + begin_[i];
    const int rows = f.rows(), left = rows - f.own;
    Waiting& out = waiting[2 * f.depth + (waiting[2 * f.depth].from ? 1 : 0)];
    out.rest.assign(static_cast<std::size_t>(left) * left, 0.F);
    add_matrix(matrix, area, f, row_of, panel);
    for (int k = 0; k < 2; ++k) {
      Waiting& child = waiting[2 * (f.depth + 1) + k];
      if (child.from) add_rest(*child.from, child.rest, f, panel, out.rest);
      child.from = nullptr;
    }
    int info = 0;
    spotrf_("L", &f.own, panel, &rows, &info);
    if (info != 0) return false;
    if (left > 0) {
      strsm_("R", "L", "T", "N", &left, &f.own, &one, panel, &rows, panel + f.own, &rows);
      ssyrk_("L", "N", &left, &f.own, &minus_one, panel + f.own, &rows, &one, out.rest.data(),
             &left);
      out.from = &f;
    }
    for (int j = 0; j < f.own; ++j) {
      float& diagonal = panel[static_cast<std::size_t>(j) * (rows + 1)];
      diagonal = 1 / diagonal;
      if (!std::isfinite(diagonal)) return false;
    }
  }
  return true;
}

void SingleFactor::forward(std::size_t front, float* x) {
  const Front& f = order_->fronts[front];
  float* const v = column_.data();
  std::copy_n(x + f.first, f.own, v);
  std::fill(v + f.own, v + f.rows(), 0.F);
  HWY_DYNAMIC_DISPATCH(eliminate)(panels_.data() + begin_[front], f.rows(), f.own, v);
  std::copy_n(v, f.own, x + f.first);
  for (std::size_t i = 0; i < f.border.size(); ++i) x[f.border[i]] += v[f.own + i];
}

void SingleFactor::backward(std::size_t front, float* x) {
  const Front& f = order_->fronts[front];
  float* const v = column_.data();
  std::copy_n(x + f.first, f.own, v);
  for (std::size_t i = 0; i < f.border.size(); ++i) v[f.own + i] = x[f.border[i]];
  std::fill_n(v + f.rows(), read_beyond, 0.F);
  HWY_DYNAMIC_DISPATCH(substitute)(panels_.data() + begin_[front], f.rows(), f.own, v);
  std::copy_n(v, f.own, x + f.first);
}

void SingleFactor::run(std::vector<Grid<double>>& x, bool both) {
  const std::size_t n = order_->samples(), fronts = order_->fronts.size();
  x_.resize(n * x.size());
  // A draw is the scale times L^-T times white numbers.
  for (std::size_t k = 0; k < x.size(); ++k)
    for (std::size_t e = 0; e < n; ++e)
      x_[k * n + e] = static_cast<float>(x[k].data()[order_->sample[e]] *
                                         (both ? static_cast<double>(scale_[e]) : 1.0));
  // A front is in the cache for all right sides but the first.
  if (both)
    for (std::size_t i = 0; i < fronts; ++i)
      for (std::size_t k = 0; k < x.size(); ++k) forward(i, &x_[k * n]);
  for (std::size_t i = fronts; i-- > 0;)
    for (std::size_t k = 0; k < x.size(); ++k) backward(i, &x_[k * n]);
  for (std::size_t k = 0; k < x.size(); ++k)
    for (std::size_t e = 0; e < n; ++e)
      x[k].data()[order_->sample[e]] = static_cast<double>(scale_[e]) * x_[k * n + e];
}

}  // namespace

std::unique_ptr<Factor> make_single_factor(std::shared_ptr<const Dissection> order) {
  return std::make_unique<SingleFactor>(std::move(order));
}

}  // namespace surf::reconstruction
#endif  // HWY_ONCE
