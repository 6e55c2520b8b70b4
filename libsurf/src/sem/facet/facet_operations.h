// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace surf::facet {

/// Factors along one axis at an offset: see FacetKernel. Across, o1 is times -mix_y and e2 times
/// -mix_x, so that the five coefficients need the four plain factors only.
template <class T>
struct Tap {
  T e0, o1, e2, o3;
};

/// What undoes that: K5 and K6 are multiplied by these.
template <class T>
struct Scaling {
  T k5, k6;
};

/// A row of a block has its moments (4: of e0, o1, e2, o3) or its coefficients (5: K2 to K6) one
/// after the other, each `columns` long.
inline constexpr int moments = 4, coefficients = 5;

/// How the invariants of a scale add up to a channel.
template <class T>
struct Weights {
  T slope, max_curvature, min_curvature;
};

/// Slopes and differences of curvatures up to these are rounding: they count as zero where they are
/// divided by.
template <class T>
struct Floors {
  T slope = 0, curvature = 0;
};

/// The inner loops. Blocks are `columns` wide, which depends on the instruction set.
template <class T>
struct Operations {
  int columns;

  /// Moments of `rows` rows; `z` is the first one's first column, with samples to both sides.
  void (*across)(const T* z, std::ptrdiff_t stride, int rows, const Tap<T>* taps, int radius,
                 T* out);

  // Rows are filtered in pairs: where their number is odd, one more lies behind what is read (its
  // values do not matter), and there is room for one more result.

  /// Coefficients of `rows` rows from the moments of theirs and of `radius` rows before and behind.
  void (*along)(const T* moment, int rows, const Tap<T>* taps, int radius,
                const Scaling<T>& scaling, T* out);

  /// The transpose of `along`, from weights of coefficients, K5's and K6's scaled, to weights of
  /// moments that are `plane` apart: into out[y], or to what is there. Taps from `begin`, at least
  /// 1, on; the centre always.
  void (*along_transposed)(const T* weight, int rows, const Tap<T>* taps, int begin, int radius,
                           bool add, T* const* out, std::ptrdiff_t plane);

  /// Turns `columns` rows of a plane by their diagonal: out[x * out_stride + y]. `count` is a
  /// multiple of columns.
  void (*turn)(const T* plane, std::ptrdiff_t stride, int count, std::ptrdiff_t out_stride, T* out);

  /// The transpose of `across` for `columns` rows at once, whose moments have been turned: at every
  /// x one after the other, `columns` each. Adds to sum[x][y] for x from 0 to `count`.
  void (*across_transposed)(const T* moment, int count, const Tap<T>* taps, int radius, T* sum);

  /// Slope and principal curvatures of `rows` rows: 3 x columns each.
  void (*invariants)(const T* k, int rows, T* out);

  /// Adds the invariants of `rows` rows, weighted, to sum[channel][row][column].
  void (*combine)(const T* k, int rows, const Weights<T>* weights, int channels, T* sum);

  /// Weights of coefficients from `weight[channel][row][column]` of the channels.
  void (*pull_back)(const T* k, int rows, const Floors<T>& floors, const Weights<T>* weights,
                    int channels, const T* weight, T* out);

  /// Adds to sum[channel][row][column] how the channels change as the coefficients change by `dk`.
  void (*push_forward)(const T* k, const T* dk, int rows, const Floors<T>& floors,
                       const Weights<T>* weights, int channels, T* sum);

  /// Tangent (the slope), secant and angle, radians, between the normals and the vertical:
  /// `columns` a row each.
  void (*angles)(const T* k, int rows, double* tangent, double* secant, double* angle);

  /// A row of `columns` values out of `count` samples, each worth[sample][column]; and the
  /// transpose, which adds to the samples.
  void (*spread)(const T* samples, int count, const T* worth, T* out);
  void (*spread_transposed)(const T* weight, int count, const T* worth, T* samples);

  /// Rows of coefficients interpolated between rows that are `step` of them apart: row y lies first
  /// + y behind the first sample. And the transpose, which adds to the samples.
  void (*between_rows)(const T* samples, int first, int step, int rows, T* out);
  void (*between_rows_transposed)(const T* weight, int first, int step, int rows, T* samples);

  /// Heights relative to a level.
  void (*relative)(const double* z, int count, double level, T* out);

  /// The largest magnitude of some values, a multiple of the lanes of a vector.
  T (*largest)(const T* values, std::ptrdiff_t count);
};

/// The best that the processor has. Results of different instruction sets differ by rounding.
template <class T>
const Operations<T>& operations();

}  // namespace surf::facet
