// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "afm_term.h"
#include "curvature_prior.h"
#include "sem_term.h"

namespace surf::reconstruction {

/// Everything that is fitted.
struct Unknowns {
  Grid<double> z_nm;  ///< on the surface's samples
  Affine surface_to_afm;
  std::vector<double> mixture;  ///< a gain for each channel and the offset; empty without SEM
  TipChange tip{};              ///< from the tip that is given
};

/// A change of it, or a derivative by it.
struct Step {
  Grid<double> z_nm;
  MapChange map{};          ///< all 0 where the map is not fitted
  MixtureChange mixture{};  ///< likewise
  TipChange tip{};          ///< likewise
};
double dot(const Step& a, const Step& b);
void add(Step& to, double factor, const Step& step);

/// The negative log-likelihood of both images and the prior, without constants, and its
/// derivatives.
class Objective {
 public:
  std::optional<AfmTerm> afm;
  std::optional<SemTerm> sem;
  CurvaturePrior prior;
  SurfaceFrame frame;
  bool fit_map = false, fit_mixture = false;
  /// Precision of a height, 1 / nm^2, that keeps a surface in place that no AFM image holds: about
  /// `start`.
  double anchor_per_nm2 = 0;
  Grid<double> start;
  /// The tip is fitted, about the one that is given. Where nothing speaks for another its slope is
  /// right within a third.
  bool fit_tip = false;
  double tip_precision = 9;

  struct State {
    std::optional<AfmTerm::State> afm;
    std::optional<SemTerm::State> sem;
    Grid<double> prior_weights;
    double afm_value = 0, sem_value = 0, prior_value = 0;
    double value() const { return afm_value + sem_value + prior_value; }
  };

  State evaluate(const Unknowns& at) const;
  Step gradient(const Unknowns& at, const State& state) const;
  /// The Gauss-Newton second derivative times v: J^T (precision or information) J, and the prior's
  /// with its weights held, which bounds it from above. Positive semidefinite. `near`, if given,
  /// stands for the SEM's J, at a third of the price.
  Step product(const Unknowns& at, const State& state, const Step& v,
               const SemTerm::Near* near = nullptr) const;
  Unknowns moved(const Unknowns& at, const Step& step) const;
  Step zero() const;
};

}  // namespace surf::reconstruction
