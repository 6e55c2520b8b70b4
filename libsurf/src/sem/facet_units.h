// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace surf::facet {

/// The vector unit that does the work. Results of different ones differ by rounding.
enum class Unit { best, portable, avx2, avx512 };

Unit resolve(Unit unit);   ///< never `best`, always available

/// Factors along one axis at an offset: see FacetKernel.
template <class T>
struct AcrossTap {
  T e0, o1, e2, o3;
};

/// Factors of the other axis, as the five coefficients need them.
template <class T>
struct AlongTap {
  T e2;       ///< K4 of moment 0
  T o3;       ///< K2 of moment 0
  T o1_mix;   ///< -mix_x o1: K2 of moment 2
  T e0;       ///< K3 of moment 3, K6 of moment 2
  T e2_mix;   ///< -mix_y e2: K3 of moment 1
  T o1;       ///< K5 of moment 1
};

/// A row of a block has its moments (4: of e0, o1, e2, o3) or its coefficients (5: K2 to K6) one after
/// the other, each `columns` long.
inline constexpr int moments = 4, coefficients = 5;

/// How the invariants of a scale add up to a channel.
template <class T>
struct Weights {
  T slope, max_curvature, min_curvature;
};

/// Slopes and differences of curvatures up to these are rounding: they count as zero where they are divided by.
template <class T>
struct Floors {
  T slope = 0, curvature = 0;
};

/// The inner loops, each compiled for every vector unit. Blocks are `columns` wide.
template <class T>
struct Operations {
  int columns;

  /// Moments of `rows` rows; `z` is the first one's first column, with samples to both sides.
  void (*across)(const T* z, std::ptrdiff_t stride, int rows, const AcrossTap<T>* taps, int radius, T* out);

  /// Coefficients of `rows` rows from the moments of the rows around: row[y + k] for k up to +-radius.
  void (*along)(const T* const* row, int rows, const AlongTap<T>* taps, int radius, T* out);

  /// The transpose of `along`: from weights of coefficients to weights of moments. Adds to out[y].
  void (*along_transposed)(const T* const* row, int rows, const AlongTap<T>* taps, int radius,
                           T* const* out, std::ptrdiff_t plane);

  /// The transpose of `across` for one row: adds to out[0 .. count), count a multiple of columns. The four
  /// moments are `plane` apart.
  void (*across_transposed)(const T* moment, std::ptrdiff_t plane, int count, const AcrossTap<T>* taps,
                            int radius, T* out);

  /// Slope and principal curvatures of `rows` rows: 3 x columns each.
  void (*invariants)(const T* k, int rows, T* out);

  /// Adds the invariants of `rows` rows, weighted, to sum[channel][row][column].
  void (*combine)(const T* k, int rows, const Weights<T>* weights, int channels, T* sum);

  /// Weights of coefficients from `weight[channel][row][column]` of the channels.
  void (*pull_back)(const T* k, int rows, const Floors<T>& floors, const Weights<T>* weights, int channels,
                    const T* weight, T* out);

  /// Adds to sum[channel][row][column] how the channels change as the coefficients change by `dk`.
  void (*push_forward)(const T* k, const T* dk, int rows, const Floors<T>& floors, const Weights<T>* weights,
                       int channels, T* sum);

  /// The largest magnitude of some values, a multiple of the lanes of a vector.
  T (*largest)(const T* values, std::ptrdiff_t count);
};

template <class T>
const Operations<T>& operations(Unit unit);

}  // namespace surf::facet
