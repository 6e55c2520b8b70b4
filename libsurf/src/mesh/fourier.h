// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <complex>
#include <functional>

#include "surf/core/grid.h"

namespace surf {

/// Multiplies the Fourier transform of a periodic grid by `gain`, a function of the frequencies
/// along x and y in cycles per sample, from -1/2 to 1/2. `gain` is called once per frequency and
/// must be even. Any size, O(n log n). Our own and not FFTW's: a seed is a surface, and has to give
/// the same one on every processor.
Grid<double> filtered(const Grid<double>& grid, const std::function<double(double, double)>& gain);

}  // namespace surf
