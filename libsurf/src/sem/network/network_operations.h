// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "sem/facet/facet_operations.h"

namespace surf::network {

// Of networks that tell directions (`sided`), and of others.
constexpr int facet_inputs(bool sided) { return sided ? 6 : 4; }     ///< per scale
constexpr int sky_band_inputs(bool sided) { return sided ? 4 : 2; }  ///< per band
constexpr int sky_inputs(int bands, bool sided) {
  return bands == 0 ? 0 : bands * sky_band_inputs(sided) + (sided ? 3 : 1);
}

/// A layer in the form that the loops need: see DenseLayer.
template <class T>
struct Layer {
  int inputs, outputs;
  const T* weights;
  const T* biases;
};

/// A sample of the sky view: its position relative to a pixel, its band, and the weight of band and
/// direction.
template <class T>
struct SkySample {
  std::ptrdiff_t offset;
  T square;  ///< of the distance, nm^2
  T weight;
  T east, north;  ///< the unit vector of its direction
  int band;
  bool ends_band;  ///< the last sample of its direction in the band
  bool last;       ///< the last sample of its direction
};

/// The inner loops. Rows of inputs, outputs and weights store their numbers one after the other,
/// each `columns` long, as in facet::Operations.
template <class T>
struct Operations {
  int columns;

  /// Computes the inputs of a scale from its coefficients, into out[row * stride].
  void (*facets)(const T* k, int rows, T length, T* out, std::ptrdiff_t stride);
  /// Computes weights of coefficients from weights of these inputs.
  void (*facets_back)(const T* k, int rows, T length, const T* weight, std::ptrdiff_t stride,
                      T* out);
  /// Computes the change of the inputs as the coefficients change by `dk`.
  void (*facets_change)(const T* k, const T* dk, int rows, T length, T* out, std::ptrdiff_t stride);

  /// Computes the sky inputs of a row from the heights `z` at its first pixel: mean and mean square
  /// of each band (sided: and the means along x and y), then the visible sky (and its mean
  /// direction).
  void (*sky)(const T* z, const SkySample<T>* samples, int count, int bands, T* out);
  /// Adds the weights of the heights to `dz`, where sample i lies at to[i]; `work` holds a
  /// row for each sample.
  void (*sky_back)(const T* z, const SkySample<T>* samples, int count, int bands, const T* weight,
                   T* dz, const std::ptrdiff_t* to, T* work);
  void (*sky_change)(const T* z, const T* dz, const SkySample<T>* samples, int count, int bands,
                     T* out);

  /// Computes values and slopes of all units, layer after layer, from a row of inputs.
  void (*forward)(const Layer<T>* layers, int count, const T* in, T* values, T* slopes);
  /// Computes weights of the inputs from those of the outputs; `work` holds twice the widest layer.
  void (*backward)(const Layer<T>* layers, int count, const T* slopes, const T* weight, T* work,
                   T* out);
  /// Computes the change of the outputs as the inputs change by `in`.
  void (*change)(const Layer<T>* layers, int count, const T* slopes, const T* in, T* work, T* out);
};

/// The fastest loops that the processor supports.
template <class T>
const Operations<T>& operations(bool sided);

}  // namespace surf::network
