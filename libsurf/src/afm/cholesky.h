// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace surf {

/// Solves A x = b for a positive definite matrix of which the lower triangle counts (row-major, n x
/// n); A becomes its factor and b the solution. False, leaving both half done, if a column depends
/// on the ones before it to within 1e-10 of its square.
bool solve_cholesky(std::vector<double>& a, std::vector<double>& b);

/// With A already factored: b becomes the solution.
void solve_factored(const std::vector<double>& a, std::vector<double>& b);

}  // namespace surf
