// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "surf/core/affine.h"
#include "surf/core/height_field.h"

namespace surf {

/// A surface that is known at every place, so that two microscopes can look at it through any map
/// and neither resamples what the other has sampled.
struct SampleSurface {
  std::string name;  ///< fit for a file's name
  std::string what;  ///< one line for people, no full stop

  /// Height in nm at a place in nm; smooth, and safe to call from several threads. The view that it
  /// is made for is 4560 x 1720 nm about (0, 0); there are features for 2500 nm or more all around
  /// it.
  std::function<double(double x_nm, double y_nm)> z_nm;
};

/// Surfaces to try a reconstruction on, after section 10.2 of the thesis: lines as oxidised into
/// silicon with an AFM's tip (nist0523-thick, nist0523-thin), pads and pits, islands of irregular
/// outline, and rough terrain. Edges are as a Gaussian blur of 15 to 18 nm makes them, up to 69
/// degrees steep. The same on every run.
const std::vector<SampleSurface>& sample_surfaces();

/// The one of that name. Throws UsageError that lists the names.
const SampleSurface& find_sample_surface(const std::string& name);

/// Sets every height of `field` to the surface's at the place that `to_surface` maps the sample to.
/// Throws InvalidInput for a pitch that is not positive.
void sample_heights(const SampleSurface& surface, const Affine& to_surface, HeightField& field,
                    int threads = 0);

}  // namespace surf
