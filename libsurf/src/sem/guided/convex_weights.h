// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

namespace surf::guided {

/// The weights a >= 0 with sum 1 that make a'Qa + 2 c'a least, found by projected gradients with
/// momentum; `matrix` is Q, symmetric and positive semidefinite, in rows.
std::vector<double> convex_weights(std::span<const double> matrix, std::span<const double> linear);

}  // namespace surf::guided
