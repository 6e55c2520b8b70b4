// SPDX-License-Identifier: GPL-3.0-or-later
#include "objective.h"

#include <algorithm>

#include "spot_blur.h"

namespace surf::reconstruction {
namespace {

constexpr double largest_tip_change = 2;  // a factor of 7.4 of the slope

/// By how much each number differs from what its prior expects.
MixtureChange off_usual(const Mixture& at) {
  return {0, 0, at.blur_px2, at.film_nm - usual_film_nm};
}

}  // namespace

MixtureChange Objective::mixture_precision() const {
  return {0, 0, fit_blur ? blur_precision : 0, fit_film ? film_precision : 0};
}

MixtureChange Objective::mixture_pull(const Mixture& at) const {
  MixtureChange pull = off_usual(at);
  const MixtureChange precision = mixture_precision();
  for (std::size_t k = 0; k < pull.size(); ++k) pull[k] *= precision[k];
  return pull;
}

double dot(const Step& a, const Step& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.z_nm.size(); ++i) sum += a.z_nm.data()[i] * b.z_nm.data()[i];
  for (std::size_t i = 0; i < a.map.size(); ++i) sum += a.map[i] * b.map[i];
  for (std::size_t i = 0; i < a.mixture.size(); ++i) sum += a.mixture[i] * b.mixture[i];
  for (std::size_t i = 0; i < a.tip.size(); ++i) sum += a.tip[i] * b.tip[i];
  for (std::size_t v = 0; v < a.views.size(); ++v) {
    for (std::size_t i = 0; i < a.views[v].pose.size(); ++i)
      sum += a.views[v].pose[i] * b.views[v].pose[i];
    for (std::size_t i = 0; i < a.views[v].mixture.size(); ++i)
      sum += a.views[v].mixture[i] * b.views[v].mixture[i];
  }
  return sum;
}

void add(Step& to, double factor, const Step& step) {
  for (std::size_t i = 0; i < to.z_nm.size(); ++i)
    to.z_nm.data()[i] += factor * step.z_nm.data()[i];
  for (std::size_t i = 0; i < to.map.size(); ++i) to.map[i] += factor * step.map[i];
  for (std::size_t i = 0; i < to.mixture.size(); ++i) to.mixture[i] += factor * step.mixture[i];
  for (std::size_t i = 0; i < to.tip.size(); ++i) to.tip[i] += factor * step.tip[i];
  for (std::size_t v = 0; v < to.views.size(); ++v) {
    for (std::size_t i = 0; i < to.views[v].pose.size(); ++i)
      to.views[v].pose[i] += factor * step.views[v].pose[i];
    for (std::size_t i = 0; i < to.views[v].mixture.size(); ++i)
      to.views[v].mixture[i] += factor * step.views[v].mixture[i];
  }
}

Objective::State Objective::evaluate(const Unknowns& at) const {
  State s;
  if (afm) {
    s.afm = afm->evaluate(at.z_nm, at.surface_to_afm, at.tip, at.drift_px);
    s.afm_value = s.afm->value;
  }
  if (sem) {
    s.sem = sem->evaluate(at.z_nm, at.mixture);
    s.sem_value = s.sem->value;
  }
  for (std::size_t v = 0; v < views.size(); ++v) {
    s.views.push_back(views[v].evaluate(at.z_nm, at.views[v]));
    s.sem_value += s.views.back().value;
  }
  s.prior_value = prior.evaluate(at.z_nm, nullptr, &s.prior_weights);
  if (anchor_per_nm2 > 0)
    for (std::size_t i = 0; i < start.size(); ++i) {
      const double d = at.z_nm.data()[i] - start.data()[i];
      s.prior_value += 0.5 * anchor_per_nm2 * d * d;
    }
  if (fit_drift)
    s.prior_value +=
        0.5 * drift_precision * (at.drift_px.x * at.drift_px.x + at.drift_px.y * at.drift_px.y);
  const MixtureChange off = off_usual(at.mixture), precision = mixture_precision();
  for (std::size_t k = 0; k < off.size(); ++k)
    s.prior_value += 0.5 * precision[k] * off[k] * off[k];
  if (fit_tip)
    for (const double t : at.tip) s.prior_value += 0.5 * tip_precision * t * t;
  return s;
}

Step Objective::zero() const {
  return {
      Grid<double>(frame.width, frame.height), {}, {}, {}, std::vector<ViewChange>(views.size())};
}

Objective::Near Objective::near(const Unknowns& at, const State& s) const {
  Near out;
  if (sem) out.sem = sem->near(*s.sem, at.mixture);
  for (std::size_t v = 0; v < views.size(); ++v)
    out.views.push_back(views[v].near(s.views[v], at.views[v]));
  return out;
}

Step Objective::gradient(const Unknowns& at, const State& s) const {
  Step g = zero();
  if (afm)
    afm->add_gradient(*s.afm, at.z_nm, s.afm->pull, g.z_nm, fit_map ? &g.map : nullptr,
                      fit_tip ? &g.tip : nullptr);
  if (sem)
    sem->add_gradient(*s.sem, at.mixture, s.sem->pull, nullptr, g.z_nm,
                      fits_mixture() ? &g.mixture : nullptr);
  for (std::size_t v = 0; v < views.size(); ++v) {
    views[v].add_gradient(s.views[v], at.views[v], s.views[v].sem.pull, nullptr, g.z_nm,
                          &g.views[v]);
    const PoseChange by_prior = views[v].prior_pull(at.views[v]);
    for (int k = 0; k < pose_numbers; ++k) g.views[v].pose[k] += by_prior[k];
    hold(g.views[v]);
  }
  if (fit_drift) {
    g.map[6] += drift_precision * at.drift_px.x;
    g.map[7] += drift_precision * at.drift_px.y;
  }
  hold(g.map);
  const MixtureChange pull = mixture_pull(at.mixture);
  for (std::size_t k = 0; k < pull.size(); ++k) g.mixture[k] += pull[k];
  hold(g.mixture);
  prior.evaluate(at.z_nm, &g.z_nm, nullptr);
  if (anchor_per_nm2 > 0)
    for (std::size_t i = 0; i < start.size(); ++i)
      g.z_nm.data()[i] += anchor_per_nm2 * (at.z_nm.data()[i] - start.data()[i]);
  if (fit_tip)
    for (int k = 0; k < tip_numbers; ++k) g.tip[k] += tip_precision * at.tip[k];
  return g;
}

Step Objective::product(const Unknowns& at, const State& s, const Step& v, const Near* near) const {
  Step out = zero();
  if (afm)
    afm->add_gradient(*s.afm, at.z_nm,
                      afm->precision(afm->change(*s.afm, at.z_nm, v.z_nm, v.map, v.tip)), out.z_nm,
                      fit_map ? &out.map : nullptr, fit_tip ? &out.tip : nullptr);
  if (sem) {
    const Grid<double> change = sem->precision(
        *s.sem, sem->change(*s.sem, at.mixture, v.z_nm, v.mixture, near ? &near->sem : nullptr));
    sem->add_gradient(*s.sem, at.mixture, change, near ? &near->sem : nullptr, out.z_nm,
                      fits_mixture() ? &out.mixture : nullptr);
  }
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ViewTerm& view = views[i];
    const SemTerm::Near* by = near ? &near->views[i] : nullptr;
    const Grid<double> change = view.sem().precision(
        s.views[i].sem, view.change(s.views[i], at.views[i], v.z_nm, v.views[i], by));
    view.add_gradient(s.views[i], at.views[i], change, by, out.z_nm, &out.views[i]);
    for (int k = 0; k < pose_numbers; ++k)
      out.views[i].pose[k] += view.prior_precision()[k] * v.views[i].pose[k];
    hold(out.views[i]);
  }
  for (int k = affine_numbers; k < map_numbers && fit_drift; ++k)
    out.map[k] += drift_precision * v.map[k];
  hold(out.map);
  const MixtureChange precision = mixture_precision();
  for (std::size_t k = 0; k < precision.size(); ++k) out.mixture[k] += precision[k] * v.mixture[k];
  hold(out.mixture);
  prior.add_product(s.prior_weights, v.z_nm, out.z_nm);
  if (anchor_per_nm2 > 0)
    for (std::size_t i = 0; i < start.size(); ++i)
      out.z_nm.data()[i] += anchor_per_nm2 * v.z_nm.data()[i];
  if (fit_tip)
    for (int k = 0; k < tip_numbers; ++k) out.tip[k] += tip_precision * v.tip[k];
  return out;
}

void Objective::hold(MixtureChange& change) const {
  for (int k = 0; k < mixture_numbers; ++k)
    if (!fits(k)) change[static_cast<std::size_t>(k)] = 0;
}

void Objective::hold(ViewChange& change) const {
  for (int k = 0; k < mixture_numbers; ++k)
    if (k > 1 || !fit_mixture) change.mixture[static_cast<std::size_t>(k)] = 0;
}

void Objective::hold(MapChange& change) const {
  for (int k = affine_numbers; k < map_numbers; ++k)
    if (!fit_drift) change[static_cast<std::size_t>(k)] = 0;
}

Unknowns Objective::moved(const Unknowns& at, const Step& step) const {
  Unknowns next = at;
  for (std::size_t i = 0; i < next.z_nm.size(); ++i) next.z_nm.data()[i] += step.z_nm.data()[i];
  if (afm && fit_map) next.surface_to_afm = afm->moved(at.surface_to_afm, step.map);
  if (fit_drift) next.drift_px = {at.drift_px.x + step.map[6], at.drift_px.y + step.map[7]};
  if (fit_mixture) {
    for (double& gain : next.mixture.gains) gain *= 1 + step.mixture[0];
    next.mixture.offset += step.mixture[1];
  }
  if (fit_blur)
    next.mixture.blur_px2 =
        std::clamp(at.mixture.blur_px2 + step.mixture[2], least_blur_px2, largest_blur_px2);
  if (fit_film)
    next.mixture.film_nm = std::clamp(at.mixture.film_nm + step.mixture[3], 0.0, largest_film_nm);
  for (std::size_t v = 0; v < views.size(); ++v)
    next.views[v] = views[v].moved(at.views[v], step.views[v], fit_mixture);
  if (fit_tip)  // limited, because a long step must not give NaN
    for (int k = 0; k < tip_numbers; ++k)
      next.tip[k] = std::clamp(at.tip[k] + step.tip[k], -largest_tip_change, largest_tip_change);
  return next;
}

}  // namespace surf::reconstruction
