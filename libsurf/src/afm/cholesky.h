// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace surf {

/// Solves A x = b for a positive definite matrix of which only the lower triangle is read
/// (row-major, n x n). A is replaced by its factor and b by the solution. Returns false and leaves
/// both incomplete if a column depends on the columns before it to within 1e-10 of its square.
bool solve_cholesky(std::vector<double>& a, std::vector<double>& b);

/// Solves A x = b with the factor of A; b is replaced by the solution.
void solve_factored(const std::vector<double>& a, std::vector<double>& b);

}  // namespace surf
