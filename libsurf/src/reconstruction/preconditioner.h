// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "objective.h"

namespace surf::reconstruction {

/// A matrix like the Gauss-Newton second derivative, but sparse, so that it can be factored: the prior's part
/// and the contacts' as if the AFM's noise were white and its samples bilinear; the SEM's part is left out.
/// The prior spans eight orders of magnitude between a plain and a long wave, which is what conjugate
/// gradients cannot bear; what the SEM adds is of the prior's size where the surface bends.
class Preconditioner {
 public:
  Preconditioner();
  ~Preconditioner();

  /// For weights and contacts of this state. The first call finds the order of elimination.
  void factor(const Objective& objective, const Unknowns& at, const Objective::State& state);
  Step solve(const Step& residual) const;

  /// The diagonal of its inverse for the heights: their variances if it were the posterior's precision. Exact, in
  /// about the time of a factorisation (Takahashi's recursion; Erisman and Tinney 1975, doi:10.1145/360680.360704).
  Grid<double> variances_nm2() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace surf::reconstruction
