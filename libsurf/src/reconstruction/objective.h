// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "afm_term.h"
#include "curvature_prior.h"
#include "sem_term.h"
#include "view_term.h"

namespace surf::reconstruction {

/// The film's thickness that the fit begins with.
constexpr double usual_film_nm = 1;

/// All unknowns of the fit.
struct Unknowns {
  Grid<double> z_nm;  ///< on the surface's samples
  Affine surface_to_afm;
  Mixture mixture;    ///< without gains if there is no SEM image
  TipChange tip{};    ///< change from the given tip
  Point2 drift_px{};  ///< of the scan, see MapChange
  std::vector<ViewUnknowns> views = {};
};

/// A change of the unknowns, or a derivative by them.
struct Step {
  Grid<double> z_nm;
  MapChange map{};          ///< 0 if the map is not fitted
  MixtureChange mixture{};  ///< 0 if not fitted
  TipChange tip{};          ///< 0 if not fitted
  std::vector<ViewChange> views = {};
};
double dot(const Step& a, const Step& b);
void add(Step& to, double factor, const Step& step);

/// The negative log-likelihood of both images and the prior, without constants, and its
/// derivatives.
class Objective {
 public:
  std::optional<AfmTerm> afm = {};
  std::optional<SemTerm> sem = {};
  std::vector<ViewTerm> views = {};
  CurvaturePrior prior;
  SurfaceFrame frame;
  bool fit_map = false;
  /// Whether the scan's drift is fitted, too, with the map. Its prior: 0, within some pixels.
  bool fit_drift = false;
  double drift_precision = 1.0 / 9;
  bool fit_mixture = false;  ///< gains and offset
  /// Whether the blur is fitted. Its prior: 0, with a deviation that a spot of half a pixel has.
  bool fit_blur = false;
  double blur_precision = 16;
  /// Whether the film's thickness is fitted. Its prior: 1 nm, within 1 nm.
  bool fit_film = false;
  double film_precision = 1;
  /// Precision of a height about `start`, 1 / nm^2. It keeps the surface in place if there is no
  /// AFM image.
  double anchor_per_nm2 = 0;
  Grid<double> start = {};
  /// Whether the tip is fitted. Its prior: the slope of the given tip is right within a third.
  bool fit_tip = false;
  double tip_precision = 9;

  struct State {
    std::optional<AfmTerm::State> afm;
    std::optional<SemTerm::State> sem;
    std::vector<ViewTerm::State> views;
    Grid<double> prior_weights;
    /// `sem_value` is that of all SEM images.
    double afm_value = 0, sem_value = 0, prior_value = 0;
    double value() const { return afm_value + sem_value + prior_value; }
  };

  State evaluate(const Unknowns& at) const;
  Step gradient(const Unknowns& at, const State& state) const;
  /// Replaces the J of the SEM images at a third of the cost: the first one's, and each view's.
  struct Near {
    SemTerm::Near sem;
    std::vector<SemTerm::Near> views;
  };
  Near near(const Unknowns& at, const State& state) const;
  /// The product of the Gauss-Newton second derivative and v: J^T (precision or information) J,
  /// plus the second derivative of the prior with fixed weights, which is an upper bound. Positive
  /// semidefinite.
  Step product(const Unknowns& at, const State& state, const Step& v,
               const Near* near = nullptr) const;
  Unknowns moved(const Unknowns& at, const Step& step) const;
  /// Whether a number of a change of the mixture is fitted.
  bool fits(int mixture_number) const {
    return mixture_number == 3 ? fit_film : mixture_number == 2 ? fit_blur : fit_mixture;
  }
  bool fits_mixture() const { return sem && (fit_mixture || fit_blur || fit_film); }
  /// The priors of the numbers of a mixture: their precisions, 0 where none is or the number is not
  /// fitted, and the derivatives of -log p.
  MixtureChange mixture_precision() const;
  MixtureChange mixture_pull(const Mixture& at) const;
  /// Zero where a number is not fitted.
  void hold(MixtureChange& change) const;
  void hold(MapChange& change) const;
  void hold(ViewChange& change) const;
  Step zero() const;
};

}  // namespace surf::reconstruction
