// SPDX-License-Identifier: GPL-3.0-or-later
#include "posterior.h"

#include <algorithm>
#include <cmath>

#include "afm/normal_numbers.h"
#include "gaussian_basis.h"

namespace surf::reconstruction {
namespace {

constexpr int rounds = 3;
constexpr int cheap_draws[rounds] = {12, 12, 48};
// The prior's weights say where the surface bends. The likeliest surface bends in as few places as
// it can, and a weight of its own curvature alone would take for granted where; images tell it to
// within some pixels.
constexpr double bend_px = 2;
constexpr std::uint64_t view_seeds = std::uint64_t{1} << 32;  // apart from those of draws
constexpr double around_px = 3;  // range over which the ratio of variances is averaged

/// A draw of the gradient's change by the noise of both images: normal, with the precision of the
/// data. `near`: see Objective::Near; null: the exact J of SEM images.
Step data_pull(const Objective& o, const Unknowns& at, const Objective::State& s,
               const Objective::Near* near, std::uint64_t seed) {
  Step r = o.zero();
  if (o.afm) {
    const Grid<double> e =
        simulate_noise(o.afm->noise(), s.afm->residual.width(), s.afm->residual.height(), seed);
    o.afm->add_gradient(*s.afm, at.z_nm, o.afm->precision(e), r.z_nm, o.fit_map ? &r.map : nullptr,
                        o.fit_tip ? &r.tip : nullptr);
    o.hold(r.map);
  }
  if (o.sem) {
    o.sem->add_gradient(*s.sem, at.mixture, o.sem->draw_precision(*s.sem, seed),
                        near ? &near->sem : nullptr, r.z_nm,
                        o.fits_mixture() ? &r.mixture : nullptr);
    o.hold(r.mixture);
  }
  for (std::size_t v = 0; v < o.views.size(); ++v) {
    const ViewTerm& view = o.views[v];
    view.add_gradient(s.views[v], at.views[v],
                      view.sem().draw_precision(s.views[v].sem, seed + view_seeds * (v + 1)),
                      near ? &near->views[v] : nullptr, r.z_nm, &r.views[v]);
    o.hold(r.views[v]);
  }
  return r;
}

/// Adds a draw of the prior's contribution.
void add_prior_pull(const Objective& o, const Objective::State& s, std::uint64_t seed, Step& r) {
  NormalNumbers normal(seed, 2);
  o.prior.for_each_difference(s.prior_weights, [&](int x, int y, int count, const int* dx,
                                                   const int* dy, const double* c, double weight) {
    const double n = std::sqrt(weight) * normal();
    for (int k = 0; k < count; ++k) r.z_nm(x + dx[k], y + dy[k]) += n * c[k];
  });
  if (o.anchor_per_nm2 > 0)
    for (double& v : r.z_nm.data()) v += std::sqrt(o.anchor_per_nm2) * normal();
  for (int k = affine_numbers; k < map_numbers && o.fit_drift; ++k)
    r.map[k] += std::sqrt(o.drift_precision) * normal();
  const MixtureChange of_mixture = o.mixture_precision();
  for (std::size_t k = 0; k < of_mixture.size(); ++k)
    if (of_mixture[k] > 0) r.mixture[k] += std::sqrt(of_mixture[k]) * normal();
  if (o.fit_tip)
    for (double& v : r.tip) v += std::sqrt(o.tip_precision) * normal();
  for (std::size_t v = 0; v < o.views.size(); ++v)
    for (int k = 0; k < pose_numbers; ++k)
      r.views[v].pose[k] += std::sqrt(o.views[v].prior_precision()[k]) * normal();
}

/// Solves A x = r by preconditioned conjugate gradients, until the residual in the preconditioner's
/// norm has fallen to `reduction` of its initial value. `product` is the product with A.
template <class Product, class Inverse>
Step solve(const Objective& o, const Product& product, const Inverse& approximate_inverse,
           const Step& right, double reduction, const Watch& watch) {
  Step x = o.zero(), r = right, z = approximate_inverse(r), p = z;
  double rz = dot(r, z);
  const double begin = rz;
  for (int i = 0; i < 500 && rz > reduction * reduction * begin; ++i) {
    watch.check();
    const Step ap = product(p);
    const double alpha = rz / dot(p, ap);
    if (!(alpha > 0)) break;
    add(x, alpha, p);
    add(r, -alpha, ap);
    z = approximate_inverse(r);
    const double next = dot(r, z), beta = next / rz;
    Step q = z;
    add(q, beta, p);
    p = std::move(q);
    rz = next;
  }
  return x;
}

template <class Product>
Step solve(const Objective& o, const Product& product, const Preconditioner& m, const Step& right,
           double reduction, const Watch& watch) {
  return solve(
      o, product, [&](const Step& r) { return m.solve(r); }, right, reduction, watch);
}

/// Solves A x = r among the unknowns that are not held.
Step solve_held(const Objective& o, const Unknowns& at, const Curvature& a, const Held& which,
                const Step& right, const Watch& watch) {
  const auto held = [&](Step v) {
    if (which.tip) v.tip = {};
    if (which.spot) v.mixture[2] = 0;
    return v;
  };
  return solve(
      o, [&](const Step& v) { return held(o.product(at, a.state, v, &a.near)); },
      [&](const Step& r) { return held(a.preconditioner->solve(r)); }, held(right), 0.05, watch);
}

}  // namespace

Curvature expected_curvature(const Objective& o, const Unknowns& at, std::uint64_t seed,
                             int threads, Precision precision, const Watch& watch) {
  Curvature a{o.evaluate(at), {}, {}, {}};
  auto m = std::make_unique<Preconditioner>(Preconditioner::usual_tile_px, threads, precision);
  const Grid<double> found = o.prior.squared_curvature(at.z_nm);
  a.near = o.near(at, a.state);
  const GaussianBasis bends(bend_px, threads);
  for (int round = 0; round < rounds; ++round) {
    m->factor(o, at, a.state);
    Preconditioner::Variances drawn = m->variances(o.prior, cheap_draws[round], seed, watch);
    a.height_nm2 = std::move(drawn.height_nm2);
    if (round + 1 == rounds) break;
    // Expected square: variance plus squared value.
    Grid<double>& curvature = drawn.curvature_per_nm2;
    for (std::size_t i = 0; i < curvature.size(); ++i) curvature.data()[i] += found.data()[i];
    curvature = bends.sum(curvature);
    a.state.prior_weights = o.prior.weights_of(curvature);
  }
  a.preconditioner = std::move(m);
  return a;
}

Step prior_bias(const Objective& o, const Unknowns& at, const Curvature& a, const Held& held,
                const Watch& watch) {
  Step pull = o.zero();
  o.prior.evaluate(at.z_nm, &pull.z_nm, nullptr);
  return solve_held(o, at, a, held, pull, watch);
}

Step change_by_tip(const Objective& o, const Unknowns& at, const Curvature& a, const Held& held,
                   const Watch& watch) {
  Step tip = o.zero();
  tip.tip = at.tip;
  return solve_held(o, at, a, {true, held.spot}, o.product(at, a.state, tip, &a.near), watch);
}

std::vector<double> deviations_of(const Objective& o, const Unknowns& at, const Curvature& a,
                                  const Step& bias, const std::vector<Step>& functions,
                                  const Watch& watch) {
  const auto product = [&](const Step& v) { return o.product(at, a.state, v, &a.near); };
  std::vector<double> out;
  for (const Step& f : functions) {
    const double variance = dot(f, solve(o, product, *a.preconditioner, f, 0.05, watch));
    out.push_back(std::hypot(std::sqrt(std::max(variance, 0.0)), dot(f, bias)));
  }
  return out;
}

Posterior posterior(const Objective& o, const Unknowns& at, const Held& held, int draws,
                    std::uint64_t seed, int threads, Precision precision, const Watch& watch) {
  const Curvature a = expected_curvature(o, at, seed, threads, precision, watch);
  const Objective::State& state = a.state;
  const Preconditioner& m = *a.preconditioner;
  const auto product = [&](const Step& v) { return o.product(at, state, v, &a.near); };
  const Grid<double> without_sem = GaussianBasis(0.8, threads).sum(a.height_nm2);
  Grid<double> drawn(o.frame.width, o.frame.height);
  for (int d = 0; d < draws; ++d) {
    watch.report(draws + d, 2 * draws);
    Step r = data_pull(o, at, state, &a.near, seed + static_cast<std::uint64_t>(d));
    add_prior_pull(o, state, seed + static_cast<std::uint64_t>(d), r);
    const Step x = solve(o, product, m, r, 0.05, watch);
    for (std::size_t i = 0; i < drawn.size(); ++i)
      drawn.data()[i] += x.z_nm.data()[i] * x.z_nm.data()[i] / draws;
  }
  const GaussianBasis around(around_px, threads);
  const Grid<double> mean = around.sum(drawn), expected = around.sum(without_sem);
  Grid<double> bias = prior_bias(o, at, a, held, watch).z_nm;
  for (double& b : bias.data()) b *= b;
  bias = around.sum(bias);
  if (o.fit_tip) {
    Grid<double> by_tip = change_by_tip(o, at, a, held, watch).z_nm;
    for (double& v : by_tip.data()) v *= v;
    by_tip = around.sum(by_tip);
    for (std::size_t i = 0; i < bias.size(); ++i) bias.data()[i] += by_tip.data()[i];
  }
  Posterior out{Grid<double>(o.frame.width, o.frame.height),
                Grid<unsigned char>(o.frame.width, o.frame.height)};
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const double ratio = mean.data()[i] / expected.data()[i];
    out.deviation_nm.data()[i] = std::sqrt(without_sem.data()[i] * ratio + bias.data()[i]);
    if (o.sem && ratio < 0.5) out.data_support.data()[i] = 2;
  }
  if (o.afm)
    for (const Contact& c : state.afm->contacts)
      if (c.inside) out.data_support(static_cast<int>(c.x + 0.5), static_cast<int>(c.y + 0.5)) |= 1;
  return out;
}

Grid<double> linear_error(const Objective& o, const Unknowns& at, const Objective::State& state,
                          const Preconditioner& m, std::uint64_t seed, const Watch& watch) {
  Step r = data_pull(o, at, state, nullptr, seed);
  Step prior = o.zero();
  o.prior.evaluate(at.z_nm, &prior.z_nm, nullptr);
  add(r, -1, prior);
  return solve(
             o, [&](const Step& v) { return o.product(at, state, v); }, m, r, 0.01, watch)
      .z_nm;
}

}  // namespace surf::reconstruction
