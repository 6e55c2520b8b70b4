// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "surf/sem/filter_bank.h"
#include "surf/sem/image_model.h"

namespace surf {

/// A layer of a network: every output is a weighted sum of all inputs and a bias.
struct DenseLayer {
  int inputs = 0, outputs = 0;
  std::vector<double> weights;  ///< [output][input]
  std::vector<double> biases;   ///< [output]
};

/// A small neural network on what the filter bank's fits say of the surface at a pixel and on how
/// much sky is seen from there. Its inputs are, for each scale of length L = 2 sigma (for uniform
/// weights 2 size / sqrt 12), with the fit's gradient g and its matrix H of half second
/// derivatives,
///     (1 + |g|^2)^(1/4) - 1,   c(L trace H),   (1 + L^2 (trace^2 H - 4 det H))^(1/4) - 1,
///     c(L g H g / (1 + |g|^2)),   where c(x) = x / (1 + x^2)^(1/4);
/// then for each band of distances, over 16 directions, the mean and the mean square of the sine s
/// of the elevation at which the surface is seen; then the mean over directions of what is left of
/// the sky, the product of 1 - 0.9 max(s, 0)^2 over all distances. Hidden units give x / sqrt(1 +
/// x^2), and a channel is its scale times o + sqrt(1 + o^2), o being an output of the last layer:
/// above zero, and linear where it is large. All of it has continuous derivatives.
struct FacetNetworkParameters {
  std::vector<FacetScale> scales;  ///< 1 to 32
  std::vector<double>
      sky_edges_nm;  ///< rising, from 0: the limits of the bands; at most 12 bands; or none
  std::vector<DenseLayer> layers;  ///< 1 to 4; the last has one output for each channel
  struct Channel {
    std::string name;
    double scale = 1;  ///< > 0
  };
  std::vector<Channel> channels;  ///< 1 to 8
};

/// How many inputs a network of these scales and bands has.
int network_inputs(const FacetNetworkParameters& parameters);

/// Throws InvalidInput for parameters out of range, or if `scope` names no pixel size.
std::shared_ptr<const ImageModel> make_facet_network(const ModelScope& scope,
                                                     const FacetNetworkParameters& parameters);

}  // namespace surf
