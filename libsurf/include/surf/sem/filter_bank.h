// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "surf/sem/image_model.h"

namespace surf {

/// A neighbourhood of the cubic facet model (thesis, 6.4 and appendix D).
struct FacetScale {
  int size = 5;  ///< samples across, odd, 5 to 255
  /// Standard deviation of the Gaussian weights, 0.3 to 1000; 0: uniform weights.
  double sigma_px = 0.6;

  friend bool operator==(const FacetScale&, const FacetScale&) = default;
};

/// The ten neighbourhoods of the thesis (6.5): 5 to 83 samples across, sigma 0.6 to 13.58.
std::vector<FacetScale> thesis_scales();

/// A channel as a linear combination of the filter bank's outputs (thesis, Equation 6-1): `offset`
/// + sum over scales of slope * |gradient| + max_curvature * kappa_plus + min_curvature *
/// kappa_minus. The gradient is in nm/nm, and the principal curvatures (eigenvalues of the matrix
/// of second derivatives) are in 1/nm.
struct FilterBankChannel {
  std::string name;
  double offset = 0;
  std::vector<double> slope, max_curvature, min_curvature;  ///< one per scale
};

struct FilterBankParameters {
  std::vector<FacetScale> scales;
  /// Fits wide neighbourhoods on heights subsampled by powers of two (thesis, 6.8.4). This is
  /// faster, but a different model, which must be trained separately.
  bool multi_resolution = false;
  std::vector<FilterBankChannel> channels;  ///< 1 to 8; SE and BSE share one pass
};

/// Throws InvalidInput for parameters out of range.
std::shared_ptr<const ImageModel> make_filter_bank(const ModelScope& scope,
                                                   const FilterBankParameters& parameters);

}  // namespace surf
