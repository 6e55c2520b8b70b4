// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "surf/core/affine.h"
#include "surf/core/height_field.h"

namespace surf {

/// A surface that is defined at every place, so that two microscopes can image it through any map
/// without resampling each other's samples.
struct SampleSurface {
  std::string name;  ///< fit for a file's name
  std::string what;  ///< description in one line, without full stop

  /// Height in nm at a place in nm. It is smooth, and several threads may call it. It is made for a
  /// view of 4560 x 1720 nm about (0, 0); features extend at least 2500 nm beyond the view on all
  /// sides.
  std::function<double(double x_nm, double y_nm)> z_nm;
};

/// Surfaces for tests of reconstructions, after section 10.2 of the thesis: lines as oxidised into
/// silicon with an AFM's tip (nist0523-thick, nist0523-thin), pads and pits, islands of irregular
/// outline, and rough terrain. Edges are blurred by Gaussians of 15 to 18 nm and are up to
/// 69 degrees steep. The same on every run.
const std::vector<SampleSurface>& sample_surfaces();

/// The sample surface called `name`. Throws UsageError that lists the names.
const SampleSurface& find_sample_surface(const std::string& name);

/// Sets every height of `field` to the surface's at the place that `to_surface` maps the sample to.
/// Throws InvalidInput for a pitch that is not positive.
void sample_heights(const SampleSurface& surface, const Affine& to_surface, HeightField& field,
                    int threads = 0);

}  // namespace surf
