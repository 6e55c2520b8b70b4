// SPDX-License-Identifier: GPL-3.0-or-later
#include "gauss_newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "preconditioner.h"

namespace surf::reconstruction {
namespace {

/// Products that take about the time of a factorisation.
constexpr int worth_a_factor = 12;

double largest(const Grid<double>& g) {
  double most = 0;
  for (const double v : g.data()) most = std::max(most, std::fabs(v));
  return most;
}

struct Inner {
  Step step;
  double promised = 0;   // by how much the quadratic model falls
  double length = 0;     // in the preconditioner's norm
  int products = 0;
  bool at_border = false;
};

/// Minimises g.d + d.A d / 2 within a ball of the preconditioner's norm.
Inner steihaug(const Objective& o, const Unknowns& at, const Objective::State& state, const Preconditioner& m,
               const Step& gradient, double radius, double reduction, int most, const Watch& watch) {
  Inner in;
  in.step = o.zero();
  Step r = gradient, z = m.solve(r), p = o.zero();
  add(p, -1, z);
  double rz = dot(r, z);
  const double begin = rz;
  if (!(rz > 0)) return in;   // nothing pulls: as at a level surface, where a model has no slope
  double dd = 0, dp = 0, pp = rz;   // products in the norm of M: of the step, the step and the direction, the direction
  while (in.products < most) {
    watch.check();
    const Step ap = o.product(at, state, p);
    ++in.products;
    const double curvature = dot(p, ap);
    if (!(curvature > 0) && !std::isfinite(radius)) return in;   // within rounding of nothing
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
    Step q = o.zero();
    add(q, -1, z);
    add(q, beta, p);
    p = std::move(q);
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
  Preconditioner m;
  double radius = std::numeric_limits<double>::infinity();
  report.ended = "iterations";
  bool stale = true;
  int fresh_products = 0;
  while (report.iterations < options.iterations) {
    options.watch.check();
    const Step gradient = o.gradient(at, state);
    report.gradient_norm = largest(gradient.z_nm);
    // Weights change little at the end: a factor is kept until the steps take more than it would.
    if (stale) m.factor(o, at, state);
    ++report.iterations;
    const double before = state.value();
    bool accepted = false;
    double fell = 0;
    for (int tries = 0; tries < 12 && !accepted; ++tries) {
      const Inner in = steihaug(o, at, state, m, gradient, radius, 0.1, options.most_products, options.watch);
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
      report.ended = "converged";
      break;
    }
  }
  return report;
}

}  // namespace surf::reconstruction
