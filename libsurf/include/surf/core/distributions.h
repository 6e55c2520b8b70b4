// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "surf/core/random.h"

namespace surf {

// The distributions of the standard library differ from one implementation to the next. These do
// not.

/// A Poisson number with this mean, 0 to 1e12. Below 10 Knuth's product of uniform numbers is used,
/// from 10 on Hörmann's transformed rejection PTRS (Insurance: Mathematics and Economics 12, 1993,
/// 39, doi:10.1016/0167-6687(93)90997-4). Both are exact.
std::int64_t poisson(double mean, RandomStream& random);

/// A binomial number: how many of `trials` (>= 0) succeed if each succeeds with `probability`, 0 to
/// 1. If fewer than 10 successes or fewer than 10 failures are expected, waiting times are summed.
/// Otherwise Hörmann's transformed rejection BTRS is used (J. Stat. Comput. Simul. 46, 1993, 101,
/// doi:10.1080/00949659308811496). Both are exact.
std::int64_t binomial(std::int64_t trials, double probability, RandomStream& random);

}  // namespace surf
