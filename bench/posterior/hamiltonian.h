// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <functional>
#include <vector>

namespace surf::bench {

/// A Hamiltonian Monte Carlo sampler (Neal 2011, arXiv:1206.1901) for a density whose coordinates
/// have been whitened, so that all have about unit variance.
struct HamiltonianOptions {
  int warm_up = 200, draws = 600;
  double length = 1.5;      ///< of a trajectory; each is this times 0.7 to 1.3
  int most_steps = 40;      ///< per trajectory
  double acceptance = 0.8;  ///< that the step is adapted to while warming up
  std::uint64_t seed = 1, chain = 0;
};

struct Chain {
  Eigen::MatrixXd draws;  ///< a column for each: what `record` gives
  double acceptance = 0, step = 0;
};

/// Minus the logarithm of the density, and its gradient.
using Energy = std::function<double(const Eigen::VectorXd& at, Eigen::VectorXd& gradient)>;

/// Begins at 0. `record` maps a place to the numbers to keep.
Chain hamiltonian(const Energy& energy, int unknowns,
                  const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& record,
                  const HamiltonianOptions& options);

/// Split R-hat (Gelman et al. 2013, 11.4) and the effective number of draws by Geyer's initial
/// positive sequence, of one number of all chains.
struct Mixing {
  double r_hat = 1, effective = 0;
};
Mixing mixing_of(const std::vector<Chain>& chains, Eigen::Index number);

}  // namespace surf::bench
