// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace surf::facet {

/// Factors along one axis at an offset: see FacetKernel. Across rows, o1 is multiplied by -mix_y
/// and e2 by -mix_x, so that the five coefficients need only the four plain factors.
template <class T>
struct Tap {
  T e0, o1, e2, o3;
};

/// Factors for K5 and K6 that undo these multiplications.
template <class T>
struct Scaling {
  T k5, k6;
};

/// A row of a block stores its moments (4: of e0, o1, e2, o3) or its coefficients (5: K2 to K6) one
/// after the other, each `columns` long.
inline constexpr int moments = 4, coefficients = 5;

/// The weights of a scale's invariants in a channel.
template <class T>
struct Weights {
  T slope, max_curvature, min_curvature;
};

/// Slopes and differences of curvatures up to these limits are rounding errors: divisions treat
/// them as zero.
template <class T>
struct Floors {
  T slope = 0, curvature = 0;
};

/// The inner loops. Blocks are `columns` wide; the number depends on the instruction set.
template <class T>
struct Operations {
  int columns;

  /// Computes the moments of `rows` rows. `z` is the first column of the first row; there are
  /// samples on both sides.
  void (*across)(const T* z, std::ptrdiff_t stride, int rows, const Tap<T>* taps, int radius,
                 T* out);

  // Rows are filtered in pairs. If their number is odd, one more row is read (its values do not
  // matter), and one more result is written.

  /// Computes the coefficients of `rows` rows from their moments and those of `radius` rows before
  /// and behind.
  void (*along)(const T* moment, int rows, const Tap<T>* taps, int radius,
                const Scaling<T>& scaling, T* out);

  /// The transpose of `along`: from weights of coefficients, with K5's and K6's scaled, to weights
  /// of moments that are `plane` apart. Writes to out[y], or adds to it. Uses the taps from `begin`
  /// >= 1 on, and always the centre.
  void (*along_transposed)(const T* weight, int rows, const Tap<T>* taps, int begin, int radius,
                           bool add, T* const* out, std::ptrdiff_t plane);

  /// Transposes `columns` rows of a plane: out[x * out_stride + y]. `count` is a multiple of
  /// columns.
  void (*turn)(const T* plane, std::ptrdiff_t stride, int count, std::ptrdiff_t out_stride, T* out);

  /// The transpose of `across` for `columns` rows at once, whose moments have been transposed: at
  /// every x one after the other, `columns` each. Adds to sum[x][y] for x from 0 to `count`.
  void (*across_transposed)(const T* moment, int count, const Tap<T>* taps, int radius, T* sum);

  /// Computes slope and principal curvatures of `rows` rows: 3 x columns each.
  void (*invariants)(const T* k, int rows, T* out);

  /// Adds the weighted invariants of `rows` rows to sum[channel][row][column].
  void (*combine)(const T* k, int rows, const Weights<T>* weights, int channels, T* sum);

  /// Computes weights of coefficients from `weight[channel][row][column]` of the channels.
  void (*pull_back)(const T* k, int rows, const Floors<T>& floors, const Weights<T>* weights,
                    int channels, const T* weight, T* out);

  /// Adds the change of the channels, as the coefficients change by `dk`, to
  /// sum[channel][row][column].
  void (*push_forward)(const T* k, const T* dk, int rows, const Floors<T>& floors,
                       const Weights<T>* weights, int channels, T* sum);

  /// Computes tangent (the slope), secant and angle, radians, between the normals and the vertical:
  /// `columns` per row each.
  void (*angles)(const T* k, int rows, double* tangent, double* secant, double* angle);

  /// Computes a row of `columns` values from `count` samples with the weights
  /// worth[sample][column]; and the transpose, which adds to the samples.
  void (*spread)(const T* samples, int count, const T* worth, T* out);
  void (*spread_transposed)(const T* weight, int count, const T* worth, T* samples);

  /// Interpolates rows of coefficients between sample rows that are `step` rows apart: row y lies
  /// first + y rows behind the first sample. And the transpose, which adds to the samples.
  void (*between_rows)(const T* samples, int first, int step, int rows, T* out);
  void (*between_rows_transposed)(const T* weight, int first, int step, int rows, T* samples);

  /// Computes heights relative to a level.
  void (*relative)(const double* z, int count, double level, T* out);

  /// The largest magnitude of some values, whose number is a multiple of the lanes of a vector.
  T (*largest)(const T* values, std::ptrdiff_t count);
};

/// The fastest loops that the processor supports. Results of different instruction sets differ by
/// rounding.
template <class T>
const Operations<T>& operations();

}  // namespace surf::facet
