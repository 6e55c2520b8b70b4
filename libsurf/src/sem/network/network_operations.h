// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "sem/facet/facet_operations.h"

namespace surf::network {

inline constexpr int facet_inputs = 4;  ///< of a scale

/// A layer as the loops take it: see DenseLayer.
template <class T>
struct Layer {
  int inputs, outputs;
  const T* weights;
  const T* biases;
};

/// A sample that the sky view looks at: where it lies from a pixel, and the weight of its band and
/// direction.
template <class T>
struct SkySample {
  std::ptrdiff_t offset;
  T per_distance;  ///< 1 / nm
  T weight;
  int band;
  bool last;  ///< of its direction
};

/// The inner loops. Rows of inputs, outputs and weights hold
/// their numbers one after the other, each `columns` long, as facet::Operations has them.
template <class T>
struct Operations {
  int columns;

  /// Inputs of a scale from its coefficients, into out[row * stride].
  void (*facets)(const T* k, int rows, T length, T* out, std::ptrdiff_t stride);
  /// Weights of coefficients from weights of those inputs.
  void (*facets_back)(const T* k, int rows, T length, const T* weight, std::ptrdiff_t stride,
                      T* out);
  /// How the inputs change as the coefficients do.
  void (*facets_change)(const T* k, const T* dk, int rows, T length, T* out, std::ptrdiff_t stride);

  /// Inputs of a row from the heights `z` at its first pixel: mean and mean square of each band,
  /// the sky.
  void (*sky)(const T* z, const SkySample<T>* samples, int count, int bands, T* out);
  /// Adds the weights of the heights to `dz`, where sample i lies at to[i]; `work` holds two
  /// rows for each sample.
  void (*sky_back)(const T* z, const SkySample<T>* samples, int count, int bands, const T* weight,
                   T* dz, const std::ptrdiff_t* to, T* work);
  void (*sky_change)(const T* z, const T* dz, const SkySample<T>* samples, int count, int bands,
                     T* out);

  /// Values and slopes of all units, layer after layer, from a row of inputs.
  void (*forward)(const Layer<T>* layers, int count, const T* in, T* values, T* slopes);
  /// Weights of the inputs from those of the outputs; `work` holds twice the widest layer.
  void (*backward)(const Layer<T>* layers, int count, const T* slopes, const T* weight, T* work,
                   T* out);
  /// How the outputs change as the inputs do.
  void (*change)(const Layer<T>* layers, int count, const T* slopes, const T* in, T* work, T* out);
};

/// The best that the processor has.
template <class T>
const Operations<T>& operations();

}  // namespace surf::network
