// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace surf::mc {

/// No length of a beam or a scan is larger, and no coordinate of a specimen is farther from 0: 10
/// km. There, coordinates are 0.002 nm apart, more than the 0.001 nm within which faces are one. A
/// sheet goes on flat to forty times its width, and Embree, which counts in single precision,
/// misses triangles of 1e16 nm and stops the program at 1.8e18 nm.
inline constexpr double largest_length_nm = 1e13;

}  // namespace surf::mc
