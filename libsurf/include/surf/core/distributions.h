// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "surf/core/random.h"

namespace surf {

// Distributions of our own: those of the standard library give other numbers with another library.

/// A Poisson number of this mean, 0 to 1e12. Below 10 as many factors as a product of uniform
/// numbers takes (Knuth), from there on Hörmann's transformed rejection PTRS (Insurance:
/// Mathematics and Economics 12, 1993, 39, doi:10.1016/0167-6687(93)90997-4). Both are exact.
std::int64_t poisson(double mean, RandomStream& random);

/// How many of `trials` (>= 0) succeed, each with this probability, 0 to 1. Where fewer than 10 are
/// expected to succeed or to fail, by waiting times; else Hörmann's transformed rejection BTRS (J.
/// Stat. Comput. Simul. 46, 1993, 101, doi:10.1080/00949659308811496). Both are exact.
std::int64_t binomial(std::int64_t trials, double probability, RandomStream& random);

}  // namespace surf
