// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace surf::mc {

/// How many of `electrons` a detector counts that sees each with probability `efficiency`:
/// binomial, a function of seed, pixel and the detector's number.
std::int64_t detected(std::int64_t electrons, double efficiency, std::uint64_t seed,
                      std::uint64_t pixel, std::uint64_t detector);

}  // namespace surf::mc
