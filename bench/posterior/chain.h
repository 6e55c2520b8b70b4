// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Dense>
#include <vector>

namespace surf::bench {

struct Chain {
  Eigen::MatrixXd draws;  ///< a column for each
  double acceptance = 1;
  double step = 1;  ///< share of a new draw in each proposal, by deviations
};

/// Split R-hat (Gelman et al. 2013, 11.4) and the effective number of draws by Geyer's initial
/// positive sequence, of one number of all chains.
struct Mixing {
  double r_hat = 1, effective = 0;
};
Mixing mixing_of(const std::vector<Chain>& chains, Eigen::Index number);

}  // namespace surf::bench
