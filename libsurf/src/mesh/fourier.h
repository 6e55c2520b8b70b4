// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <complex>
#include <functional>

#include "surf/core/grid.h"

namespace surf {

/// Multiplies the Fourier transform of a periodic grid by `gain`, a function of the frequencies
/// along x and y in cycles per sample, from -1/2 to 1/2. `gain` must be even and is called once per
/// frequency. Works for any size in O(n log n). This code does not use FFTW, because a seed must
/// give the same surface on every processor.
Grid<double> filtered(const Grid<double>& grid, const std::function<double(double, double)>& gain);

}  // namespace surf
