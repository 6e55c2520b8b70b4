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

/// A small neural network. Its inputs come from the filter bank's fits to the surface at a pixel,
/// and from the visible sky. For each scale of length L = 2 sigma (2 size / sqrt 12 for uniform
/// weights), with the gradient g of the fit and its matrix H of half second derivatives, the inputs
/// are
///     (1 + |g|^2)^(1/4) - 1,   c(L trace H),   (1 + L^2 (trace^2 H - 4 det H))^(1/4) - 1,
///     c(L g H g / (1 + |g|^2)),   where c(x) = x / (1 + x^2)^(1/4).
/// For each band of distances, there are the mean and the mean square over 16 directions of the
/// sine s of the elevation of the surface. The last input is the visible sky: the mean over
/// directions of the product of 1 - 0.9 max(s, 0)^2 over all distances. So rotations of the surface
/// rotate the image. A network for detectors that look from a side has inputs that tell directions,
/// too (`sided`): for each scale g / (1 + |g|^2)^(1/4), for each band the mean of s u, where u is
/// the unit vector of the direction, and the mean of u times the product. The activation function
/// of hidden units is x / sqrt(1 + x^2). A channel is its scale times o + sqrt(1 + o^2), where o is
/// an output of the last layer: it is above zero, and linear for large o. All functions have
/// continuous derivatives.
struct FacetNetworkParameters {
  std::vector<FacetScale> scales;  ///< 1 to 32
  /// Limits of the bands, rising from 0; at most 12 bands, or none.
  std::vector<double> sky_edges_nm;
  bool sided = false;              ///< some channel looks from a side
  std::vector<DenseLayer> layers;  ///< 1 to 4; the last has one output for each channel
  struct Channel {
    std::string name;
    double scale = 1;  ///< > 0
  };
  std::vector<Channel> channels;  ///< 1 to 8
};

/// The number of inputs of a network with these scales and bands.
int network_inputs(const FacetNetworkParameters& parameters);

/// Throws InvalidInput for parameters out of range, or if `scope` names no pixel size.
std::shared_ptr<const ImageModel> make_facet_network(const ModelScope& scope,
                                                     const FacetNetworkParameters& parameters);

}  // namespace surf
