// SPDX-License-Identifier: GPL-3.0-or-later
#include "gauss_newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "preconditioner.h"

namespace surf::reconstruction {
namespace {

/// The number of products that take as long as a factorisation.
constexpr int worth_a_factor = 12;

/// Usual iterations of half a scale: the reported progress always assumes this many more.
constexpr int usual_iterations = 10;

double largest(const Grid<double>& g) {
  double most = 0;
  for (const double v : g.data()) most = std::max(most, std::fabs(v));
  return most;
}

struct Inner {
  Step step;
  double promised = 0;  // predicted decrease by the quadratic model
  double length = 0;    // in the preconditioner's norm
  int products = 0;
  bool at_border = false;
};

/// The quadratic model of the objective about a point, g.d + d.A d / 2.
struct Quadratic {
  const Objective& objective;
  const Unknowns& at;
  const Objective::State& state;
  const Objective::Near& near;
  Step gradient;

  Step product(const Step& v) const { return objective.product(at, state, v, &near); }
};

/// Minimises the model within a ball of the preconditioner's norm, until the residual has fallen to
/// `reduction` of its initial value.
Inner steihaug(const Quadratic& q, const Preconditioner& m, double radius, double reduction,
               int most, const Watch& watch) {
  Inner in;
  in.step = q.objective.zero();
  Step r = q.gradient, z = m.solve(r), p = in.step;
  add(p, -1, z);
  double rz = dot(r, z);
  const double begin = rz;
  if (!(rz > 0)) return in;  // no gradient, as at a level surface, where a model has no slope
  // Products in the norm of M: step with step, step with direction, direction with direction.
  double dd = 0, dp = 0, pp = rz;
  while (in.products < most) {
    watch.check();
    const Step ap = q.product(p);
    ++in.products;
    const double curvature = dot(p, ap);
    if (!(curvature > 0) && !std::isfinite(radius)) return in;  // zero within rounding
    const double alpha = rz / curvature;
    const double next = dd + 2 * alpha * dp + alpha * alpha * pp;
    if (!(curvature > 0) || next >= radius * radius) {
      const double tau = (-dp + std::sqrt(dp * dp + pp * (radius * radius - dd))) / pp;
      add(in.step, tau, p);
      in.promised += tau * rz - 0.5 * tau * tau * curvature;
      in.length = radius;
      in.at_border = true;
      return in;
    }
    add(in.step, alpha, p);
    in.promised += 0.5 * alpha * rz;
    dd = next;
    add(r, alpha, ap);
    z = m.solve(r);
    const double rz_next = dot(r, z);
    if (rz_next <= reduction * reduction * begin) break;
    const double beta = rz_next / rz;
    Step next_p = q.objective.zero();
    add(next_p, -1, z);
    add(next_p, beta, p);
    p = std::move(next_p);
    dp = beta * (dp + alpha * pp);
    pp = rz_next + beta * beta * pp;
    rz = rz_next;
  }
  in.length = std::sqrt(std::max(dd, 0.0));
  return in;
}

}  // namespace

DescentReport gauss_newton(const Objective& o, Unknowns& at, const DescentOptions& options) {
  DescentReport report;
  Objective::State state = o.evaluate(at);
  ++report.evaluations;
  Preconditioner m(Preconditioner::usual_tile_px, options.threads, options.precision);
  Objective::Near near;
  double radius = std::numeric_limits<double>::infinity();
  report.ended = "iterations";
  bool stale = true;
  int fresh_products = 0;
  while (report.iterations < options.iterations) {
    options.watch.report(report.iterations, report.iterations + usual_iterations);
    // Near the end little changes: factorisation and SEM approximation are kept until the steps
    // with them cost more than renewing them.
    const bool fresh = stale;
    if (stale) {
      m.factor(o, at, state);
      report.factors += m.tiles();
      report.double_factors += m.double_tiles();
      near = o.near(at, state);
    }
    const Quadratic quadratic{o, at, state, near, o.gradient(at, state)};
    report.gradient_norm = largest(quadratic.gradient.z_nm);
    ++report.iterations;
    const double before = state.value();
    bool accepted = false;
    double fell = 0;
    for (int tries = 0; tries < 12 && !accepted; ++tries) {
      const Inner in = steihaug(quadratic, m, radius, 0.1, options.most_products, options.watch);
      report.products += in.products;
      if (stale) fresh_products = in.products;
      stale = in.products > fresh_products + worth_a_factor;
      const Unknowns next = o.moved(at, in.step);
      Objective::State there = o.evaluate(next);
      ++report.evaluations;
      fell = before - there.value();
      const double ratio = fell / in.promised;
      if (ratio > 1e-3) {
        at = next;
        state = std::move(there);
        accepted = true;
      }
      if (ratio < 0.25) radius = 0.25 * in.length;
      else if (ratio > 0.75 && in.at_border) radius *= 2;
      if (in.promised < options.tolerance) break;
    }
    if (!accepted || fell < options.tolerance) {
      if (fresh) {
        report.ended = "converged";
        break;
      }
      stale = true;  // what the step was made of may be what held it back
    }
  }
  return report;
}

}  // namespace surf::reconstruction
