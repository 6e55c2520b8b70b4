// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "surf/mc/physics/dielectric_draft.h"
#include "surf/mc/physics/formula.h"
#include "surf/mc/physics/material.h"

namespace surf::mc {

/// What is known of a material; `complete` estimates the rest. Fields mean what they mean in
/// Material, except that a zero in `constituents` is filled in:
/// - atomic_weight: the element's standard weight; mean_ionization_ev: `mean_ionization_ev(Z)`.
struct MaterialDraft {
  std::string name;
  double density_g_cm3 = 0;
  std::vector<FormulaPart> formula;       ///< either this
  std::vector<Constituent> constituents;  ///< or this; the formula unit is then the mean atom
  std::optional<double> work_function_ev, barrier_ev, valence_electrons, plasmon_ev, loss_join_ev;
  std::optional<double> band_gap_ev;  ///< 0 for metals
  bool loss_join_fitted = false;
  DielectricDraft dielectric;
  std::string sources;
};

/// The material, with every missing value estimated and listed in `estimates` (but for the third of
/// gap, barrier and work function where two are given: it follows):
/// - valence_electrons: the sum of the elements' own (surf/mc/physics/element.h);
/// - plasmon_ev: of a free-electron gas of these, 28.816 eV sqrt(n rho / M);
/// - work_function_ev W: with a gap, gap + barrier, or where that is missing gap + 4 eV below a gap
/// of
///   4 eV and gap + 1 eV above; without one, the mean over the atoms where `known` has all elements
///   as pure materials, otherwise 4.5 eV;
/// - barrier_ev U0: with a gap, W - gap; without one, W plus the mean over the atoms of U0 - W
/// where
///   `known` has all elements, otherwise W plus the Fermi energy of a free-electron gas of the
///   elements' free electrons;
/// - loss_join_ev E_b: `estimated_loss_join_ev`;
/// - dielectric: see dielectric_draft.h.
/// Throws InvalidInput, as `validate` does.
Material complete(const MaterialDraft& draft, std::span<const Material> known = {});

/// E_b where no measured SE yields are at hand: 6.72 U0 + 1.87 gap, the regression over the fitted
/// materials (bench/fit_loss_join), at least W + 2 eV. The gap is W - U0, 0 for metals.
double estimated_loss_join_ev(double barrier_ev, double work_function_ev);

}  // namespace surf::mc
