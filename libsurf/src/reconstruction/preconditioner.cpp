// SPDX-License-Identifier: GPL-3.0-or-later
#include "preconditioner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "afm/normal_numbers.h"
#include "reconstruction/in_chunks.h"
#include "surf/core/parallel.h"

namespace surf::reconstruction {
namespace {

/// The overlap of neighbouring tiles in samples: three times the range of a contact's influence in
/// a flat part.
constexpr int overlap_px = 10;

/// Draws that read a factor together: more do not take less time.
constexpr int draws_at_once = 12;

/// The bilinear weights of a place within the samples.
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

void add_prior(const Objective& o, const Objective::State& s, StencilMatrix& m) {
  o.prior.for_each_difference(s.prior_weights, [&](int x, int y, int count, const int* dx,
                                                   const int* dy, const double* c, double weight) {
    for (int a = 0; a < count; ++a)
      for (int b = a; b < count; ++b)
        m.add(x + dx[a], y + dy[a], x + dx[b], y + dy[b], weight * c[a] * c[b]);
  });
  double largest = 0;
  for (const double p : s.prior_weights.data()) largest = std::max(largest, p);
  const double ground = o.anchor_per_nm2 + 1e-12 * largest * std::pow(o.frame.pitch_nm, -4);
  for (int y = 0; y < m.height(); ++y)
    for (int x = 0; x < m.width(); ++x) m.add(x, y, x, y, ground);
}

void add_contacts(const Objective& o, const Objective::State& s, StencilMatrix& m) {
  const double q =
      (1 - o.afm->noise().alpha * o.afm->noise().alpha) / o.afm->noise().innovation_nm2;
  for (const Contact& c : s.afm->contacts) {
    if (!c.inside) continue;
    const Corners k(c, m.width(), m.height());
    for (int a = 0; a < 4; ++a)
      for (int b = a; b < 4; ++b)
        m.add(k.x + a % 2, k.y + a / 2, k.x + b % 2, k.y + b / 2, q * k.w[a] * k.w[b]);
  }
}

double product(const Grid<double>& a, const Grid<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a.data()[i] * b.data()[i];
  return sum;
}

/// The symmetric matrix with eigenvalues of at least `least` that is nearest to `m`.
Eigen::MatrixXd at_least(const Eigen::MatrixXd& m, double least) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(0.5 * (m + m.transpose()));
  return parts.eigenvectors() * parts.eigenvalues().cwiseMax(least).asDiagonal() *
         parts.eigenvectors().transpose();
}

/// The samples [begin, end) of a tile along one axis, including the overlap, and their weights.
struct Span {
  int begin = 0, end = 0, own_begin = 0, own_end = 0;
  std::vector<double> weights;
};

/// Divides an axis into equal, overlapping parts with weights that add up to 1.
std::vector<Span> spans(int samples, int tile) {
  const int count =
      tile > 0 ? std::max(1, static_cast<int>(std::lround(samples / static_cast<double>(tile))))
               : 1;
  std::vector<Span> out;
  for (int i = 0; i < count; ++i) {
    const bool first = i == 0, last = i + 1 == count;
    const auto cut = [&](int k) {
      return static_cast<int>(static_cast<std::int64_t>(samples) * k / count);
    };
    Span s{first ? 0 : cut(i) - overlap_px,
           last ? samples : cut(i + 1) + overlap_px,
           cut(i),
           cut(i + 1),
           {}};
    for (int x = s.begin; x < s.end; ++x) {
      double weight = 1;
      if (!first) weight = std::min(weight, (x + 0.5 - s.begin) / (2 * overlap_px));
      if (!last) weight = std::min(weight, (s.end - x - 0.5) / (2 * overlap_px));
      s.weights.push_back(weight);
    }
    out.push_back(std::move(s));
  }
  return out;
}

}  // namespace

struct Preconditioner::Blocks {
  Eigen::LDLT<Eigen::MatrixXd> map, mixture, tip;
  std::vector<Eigen::LDLT<Eigen::MatrixXd>> views;
  // Response of the surface to the tip, number by number at each sample.
  std::vector<float> follows;
  bool has_map = false, has_mixture = false, has_tip = false;

  void eliminate_tip(const Objective& o, const Objective::State& s, const Preconditioner& surface);
  /// Adds what map, mixture and tip contribute to a solution of the heights alone.
  void solve(const Step& residual, Step& out, int threads) const;
};

/// Eliminates the tip together with the surface. At a contact, tip and surface can compensate each
/// other, so separate blocks would leave a long valley. Tiles are not an exact inverse, so the
/// remaining block could fall below the tip's prior; it is limited to the prior.
void Preconditioner::Blocks::eliminate_tip(const Objective& o, const Objective::State& s,
                                           const Preconditioner& surface) {
  const int w = o.frame.width, h = o.frame.height;
  const double q =
      (1 - o.afm->noise().alpha * o.afm->noise().alpha) / o.afm->noise().innovation_nm2;
  Eigen::MatrixXd block = o.tip_precision * Eigen::MatrixXd::Identity(tip_numbers, tip_numbers);
  std::array<Step, tip_numbers> coupling;
  coupling.fill(o.zero());
  for (const Contact& c : s.afm->contacts) {
    if (c.tip_sample < 0) continue;
    const TipChange& d = s.afm->by_tip[c.tip_sample];
    for (int i = 0; i < tip_numbers; ++i)
      for (int k = 0; k <= i; ++k) block(i, k) += q * d[i] * d[k];
    if (!c.inside) continue;
    const Corners at(c, w, h);
    for (int k = 0; k < tip_numbers; ++k)
      for (int a = 0; a < 4; ++a)
        coupling[k].z_nm(at.x + a % 2, at.y + a / 2) += q * at.w[a] * d[k];
  }
  has_tip = false;
  const std::vector<Step> responses = surface.solve({coupling.begin(), coupling.end()});
  has_tip = true;
  const std::size_t samples = responses[0].z_nm.size();
  follows.resize(samples * tip_numbers);
  for (std::size_t k = 0; k < tip_numbers; ++k)
    for (std::size_t i = 0; i < samples; ++i)
      follows[i * tip_numbers + k] = static_cast<float>(responses[k].z_nm.data()[i]);
  parallel_for(tip_numbers, surface.threads_, [&](std::size_t i, int) {
    for (std::size_t k = 0; k <= i; ++k)
      block(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) -=
          product(coupling[i].z_nm, responses[k].z_nm);
  });
  block.triangularView<Eigen::StrictlyUpper>() = block.transpose();
  tip.compute(at_least(block, o.tip_precision));
}

Preconditioner::Preconditioner(int tile_px, int threads, Precision precision)
    : tile_px_(tile_px), threads_(resolve_threads(threads)), precision_(precision),
      blocks_(std::make_unique<Blocks>()) {}
Preconditioner::~Preconditioner() = default;

void Preconditioner::make_tiles(int width, int height) {
  // Tiles are so wide that a sample lies in at most two tiles along each axis.
  const int tile = tile_px_ > 0 ? std::max(tile_px_, 4 * overlap_px) : 0;
  // Tiles of the same size share one dissection.
  std::map<std::pair<int, int>, std::shared_ptr<const Dissection>> orders;
  for (const Span& v : spans(height, tile))
    for (const Span& u : spans(width, tile)) {
      const int across = u.end - u.begin, along = v.end - v.begin;
      auto& order = orders[{across, along}];
      if (!order) order = std::make_shared<Dissection>(across, along);
      Tile t{{u.begin, v.begin, u.end, v.end},
             {u.own_begin, v.own_begin, u.own_end, v.own_end},
             Grid<double>(across, along),
             SparseFactor(order, precision_)};
      for (int y = 0; y < t.share.height(); ++y)
        for (int x = 0; x < t.share.width(); ++x)
          t.share(x, y) = std::sqrt(u.weights[x] * v.weights[y]);
      tiles_.push_back(std::move(t));
    }
}

void Preconditioner::factor(const Objective& o, const Unknowns& at, const Objective::State& s) {
  const int w = o.frame.width, h = o.frame.height;
  const auto m = std::make_shared<StencilMatrix>(w, h);
  add_prior(o, s, *m);
  if (o.afm) add_contacts(o, s, *m);
  if (tiles_.empty()) make_tiles(w, h);
  const OneBlasThread alone;
  parallel_for(tiles_.size(), std::min(threads_, OneBlasThread::most_at_once()),
               [&](std::size_t i, int) { tiles_[i].factor.compute(m, tiles_[i].area); });

  // Map and mixture have blocks of their own.
  Blocks& few = *blocks_;
  few.has_map = o.afm && o.fit_map;
  if (few.has_map) {
    Eigen::MatrixXd block(map_numbers, map_numbers);
    for (int k = 0; k < map_numbers; ++k) {
      MapChange unit{};
      unit[k] = 1;
      const Grid<double> none(w, h);
      Grid<double> unused(w, h);
      MapChange column{};
      o.afm->add_gradient(*s.afm, at.z_nm,
                          o.afm->precision(o.afm->change(*s.afm, at.z_nm, none, unit)), unused,
                          &column);
      for (int i = 0; i < map_numbers; ++i) block(i, k) = column[i];
    }
    for (int k = affine_numbers; k < map_numbers; ++k) {
      if (!o.fit_drift) block.row(k).setZero(), block.col(k).setZero();
      block(k, k) += o.fit_drift ? o.drift_precision : 1;
    }
    block = 0.5 * (block + block.transpose()).eval();
    block.diagonal().array() *= 1 + 1e-9;
    block.diagonal().array() += 1e-12;
    few.map.compute(block);
  }
  few.has_mixture = o.fits_mixture();
  if (few.has_mixture) {
    const auto precision = o.sem->mixture_precision(*s.sem, at.mixture);
    Eigen::MatrixXd block = Eigen::MatrixXd::Identity(mixture_numbers, mixture_numbers);
    for (int i = 0; i < mixture_numbers; ++i)
      for (int k = 0; k < mixture_numbers; ++k)
        if (o.fits(i) && o.fits(k)) block(i, k) = 0.5 * (precision[i][k] + precision[k][i]);
    const MixtureChange prior = o.mixture_precision();
    for (int k = 0; k < mixture_numbers; ++k) block(k, k) += prior[static_cast<std::size_t>(k)];
    block.diagonal().array() *= 1 + 1e-9;
    few.mixture.compute(block);
  }
  few.views.clear();
  for (std::size_t v = 0; v < o.views.size(); ++v) {
    const auto of_view = o.views[v].block(s.views[v], at.views[v], o.fit_mixture, nullptr);
    Eigen::MatrixXd block(ViewTerm::numbers, ViewTerm::numbers);
    for (int i = 0; i < ViewTerm::numbers; ++i)
      for (int k = 0; k < ViewTerm::numbers; ++k)
        block(i, k) = 0.5 * (of_view[i][k] + of_view[k][i]);
    block.diagonal().array() *= 1 + 1e-9;
    few.views.emplace_back(block);
  }
  few.has_tip = false;
  if (o.afm && o.fit_tip) few.eliminate_tip(o, s, *this);
}

Step Preconditioner::solve(const Step& residual) const {
  return std::move(solve(std::vector<Step>{residual}).front());
}

std::vector<Grid<double>> Preconditioner::solve_heights(const std::vector<Step>& r) const {
  std::vector<std::vector<Grid<double>>> parts(tiles_.size());
  parallel_for(
      tiles_.size(), std::min(threads_, OneBlasThread::most_at_once()), [&](std::size_t i, int) {
        const Tile& t = tiles_[i];
        for (const Step& one : r) {
          Grid<double> right(t.area.width(), t.area.height());
          for (int y = 0; y < right.height(); ++y)
            for (int x = 0; x < right.width(); ++x)
              right(x, y) = t.share(x, y) * one.z_nm(x + t.area.x_begin, y + t.area.y_begin);
          parts[i].push_back(std::move(right));
        }
        if (tile_px_ > 0) t.factor.solve_coarsely(parts[i]);
        else t.factor.solve(parts[i]);
      });
  std::vector<Grid<double>> out;
  for (std::size_t k = 0; k < r.size(); ++k) {
    out.emplace_back(r[k].z_nm.width(), r[k].z_nm.height());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Tile& t = tiles_[i];
      for (int y = 0; y < t.area.height(); ++y)
        for (int x = 0; x < t.area.width(); ++x)
          out[k](x + t.area.x_begin, y + t.area.y_begin) += t.share(x, y) * parts[i][k](x, y);
    }
  }
  return out;
}

std::vector<Step> Preconditioner::solve(const std::vector<Step>& residuals) const {
  const OneBlasThread alone;
  std::vector<Grid<double>> heights = solve_heights(residuals);
  std::vector<Step> out(residuals.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].z_nm = std::move(heights[i]);
    blocks_->solve(residuals[i], out[i], threads_);
  }
  return out;
}

void Preconditioner::Blocks::solve(const Step& r, Step& out, int threads) const {
  if (has_map)
    Eigen::Map<Eigen::VectorXd>(out.map.data(), map_numbers) =
        map.solve(Eigen::Map<const Eigen::VectorXd>(r.map.data(), map_numbers));
  if (has_mixture)
    Eigen::Map<Eigen::VectorXd>(out.mixture.data(), mixture_numbers) =
        mixture.solve(Eigen::Map<const Eigen::VectorXd>(r.mixture.data(), mixture_numbers));
  out.views.resize(r.views.size());
  for (std::size_t v = 0; v < views.size(); ++v) {
    Eigen::VectorXd right(ViewTerm::numbers);
    for (int k = 0; k < ViewTerm::numbers; ++k)
      right(k) = k < pose_numbers ? r.views[v].pose[k] : r.views[v].mixture[k - pose_numbers];
    const Eigen::VectorXd solved = views[v].solve(right);
    for (int k = 0; k < ViewTerm::numbers; ++k)
      (k < pose_numbers ? out.views[v].pose[k] : out.views[v].mixture[k - pose_numbers]) =
          solved(k);
  }
  if (!has_tip) return;
  Eigen::VectorXd right = Eigen::Map<const Eigen::VectorXd>(r.tip.data(), tip_numbers);
  const std::size_t samples = out.z_nm.size();
  std::array<TipChange, chunks> sums{};
  in_chunks(samples, threads, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    TipChange sum{};
    for (std::size_t i = begin; i < end; ++i) {
      const double value = r.z_nm.data()[i];
      const float* const follow = &follows[i * tip_numbers];
      for (int k = 0; k < tip_numbers; ++k) sum[k] += value * double{follow[k]};
    }
    sums[chunk] = sum;
  });
  for (const TipChange& sum : sums)
    for (int k = 0; k < tip_numbers; ++k) right(k) -= sum[k];
  const Eigen::VectorXd solved = tip.solve(right);
  std::copy_n(solved.data(), tip_numbers, out.tip.begin());
  const TipChange change = out.tip;
  in_chunks(samples, threads, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const float* const follow = &follows[i * tip_numbers];
      double sum = 0;
      for (int k = 0; k < tip_numbers; ++k) sum += change[k] * double{follow[k]};
      out.z_nm.data()[i] -= sum;
    }
  });
}

Preconditioner::Variances Preconditioner::variances(const CurvaturePrior& prior, int draws,
                                                    std::uint64_t seed, const Watch& watch) const {
  const OneBlasThread alone;
  int width = 0, height = 0;
  for (const Tile& t : tiles_) {
    width = std::max(width, t.area.x_end);
    height = std::max(height, t.area.y_end);
  }
  Variances out{Grid<double>(width, height), Grid<double>(width, height)};
  parallel_for(tiles_.size(), std::min(threads_, OneBlasThread::most_at_once()),
               [&](std::size_t i, int) {
                 const Tile& t = tiles_[i];
                 NormalNumbers normal(seed, 3 + i);
                 for (int begun = 0; begun < draws; begun += draws_at_once) {
                   if (watch.cancelled()) return;
                   std::vector<Grid<double>> drawn(std::min(draws_at_once, draws - begun),
                                                   Grid<double>(t.area.width(), t.area.height()));
                   for (Grid<double>& white : drawn)
                     for (double& v : white.data()) v = normal();
                   t.factor.draw(drawn);
                   for (const Grid<double>& z : drawn) {
                     const Grid<double> curvature = prior.squared_curvature(z);
                     for (int y = t.own.y_begin; y < t.own.y_end; ++y)
                       for (int x = t.own.x_begin; x < t.own.x_end; ++x) {
                         const int u = x - t.area.x_begin, v = y - t.area.y_begin;
                         out.height_nm2(x, y) += z(u, v) * z(u, v) / draws;
                         out.curvature_per_nm2(x, y) += curvature(u, v) / draws;
                       }
                   }
                 }
               });
  watch.check();
  return out;
}

int Preconditioner::tiles() const { return static_cast<int>(tiles_.size()); }
int Preconditioner::double_tiles() const {
  return static_cast<int>(std::count_if(tiles_.begin(), tiles_.end(),
                                        [](const Tile& t) { return !t.factor.is_single(); }));
}
double Preconditioner::flops() const {
  double sum = 0;
  for (const Tile& t : tiles_) sum += t.factor.order().flops();
  return sum;
}
std::size_t Preconditioner::bytes() const {
  std::size_t sum = 0;
  for (const Tile& t : tiles_) sum += t.factor.bytes();
  return sum;
}

}  // namespace surf::reconstruction
