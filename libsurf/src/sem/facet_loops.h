// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "facet_units.h"

// Compiled once for each vector unit. Everything is inlined into functions that are compiled for it, and
// nothing of the standard library is called.
namespace surf::facet {

#define SEMSURF_INLINE [[gnu::always_inline]] inline

/// Vectors that are made together: what is broadcast serves them all, and all sums stay in registers.
inline constexpr int vectors = 2;

template <class T, int Bytes>
struct Loops {
  typedef T V [[gnu::vector_size(Bytes)]];
  static constexpr int lanes = Bytes / static_cast<int>(sizeof(T));
  static constexpr int columns = vectors * lanes;

  SEMSURF_INLINE static void load(V& v, const T* p) { __builtin_memcpy(&v, p, sizeof v); }
  SEMSURF_INLINE static void store(T* p, const V& v) { __builtin_memcpy(p, &v, sizeof v); }
  SEMSURF_INLINE static void add(T* p, const V& v) {
    V sum;
    load(sum, p);
    store(p, sum + v);
  }

  SEMSURF_INLINE static void across(const T* z, std::ptrdiff_t stride, int rows, const AcrossTap<T>* taps,
                                    int radius, T* out) {
    for (int y = 0; y < rows; ++y, z += stride, out += moments * columns) {
      V m0[vectors], m1[vectors], m2[vectors], m3[vectors];
      for (int v = 0; v < vectors; ++v) {
        V centre;
        load(centre, z + v * lanes);
        m0[v] = centre * taps[0].e0;
        m2[v] = centre * taps[0].e2;
        m1[v] = m3[v] = V{};
      }
      for (int k = 1; k <= radius; ++k) {
        const AcrossTap<T> t = taps[k];
        for (int v = 0; v < vectors; ++v) {
          V right, left;
          load(right, z + v * lanes + k);
          load(left, z + v * lanes - k);
          const V sum = right + left, difference = right - left;
          m0[v] += sum * t.e0;
          m1[v] += difference * t.o1;
          m2[v] += sum * t.e2;
          m3[v] += difference * t.o3;
        }
      }
      for (int v = 0; v < vectors; ++v) {
        store(out + v * lanes, m0[v]);
        store(out + columns + v * lanes, m1[v]);
        store(out + 2 * columns + v * lanes, m2[v]);
        store(out + 3 * columns + v * lanes, m3[v]);
      }
    }
  }

  SEMSURF_INLINE static void along(const T* const* row, int rows, const AlongTap<T>* taps, int radius, T* out) {
    for (int y = 0; y < rows; ++y, ++row, out += coefficients * columns) {
      V k2[vectors], k3[vectors], k4[vectors], k5[vectors], k6[vectors];
      for (int v = 0; v < vectors; ++v) {
        const T* const c = row[0] + v * lanes;
        V m;
        load(m, c);
        k4[v] = m * taps[0].e2;
        load(m, c + columns);
        k3[v] = m * taps[0].e2_mix;
        load(m, c + 2 * columns);
        k6[v] = m * taps[0].e0;
        load(m, c + 3 * columns);
        k3[v] += m * taps[0].e0;
        k2[v] = k5[v] = V{};
      }
      for (int k = 1; k <= radius; ++k) {
        const T *const up = row[k], *const down = row[-k];
        const AlongTap<T>& t = taps[k];
        for (int v = 0; v < vectors; ++v) {
          V a, b;
          load(a, up + v * lanes);
          load(b, down + v * lanes);
          k4[v] += (a + b) * t.e2;
          k2[v] += (a - b) * t.o3;
        }
        for (int v = 0; v < vectors; ++v) {
          V a, b;
          load(a, up + columns + v * lanes);
          load(b, down + columns + v * lanes);
          k3[v] += (a + b) * t.e2_mix;
          k5[v] += (a - b) * t.o1;
        }
        for (int v = 0; v < vectors; ++v) {
          V a, b;
          load(a, up + 2 * columns + v * lanes);
          load(b, down + 2 * columns + v * lanes);
          k6[v] += (a + b) * t.e0;
          k2[v] += (a - b) * t.o1_mix;
        }
        for (int v = 0; v < vectors; ++v) {
          V a, b;
          load(a, up + 3 * columns + v * lanes);
          load(b, down + 3 * columns + v * lanes);
          k3[v] += (a + b) * t.e0;
        }
      }
      for (int v = 0; v < vectors; ++v) {
        store(out + v * lanes, k2[v]);
        store(out + columns + v * lanes, k3[v]);
        store(out + 2 * columns + v * lanes, k4[v]);
        store(out + 3 * columns + v * lanes, k5[v]);
        store(out + 4 * columns + v * lanes, k6[v]);
      }
    }
  }

  SEMSURF_INLINE static void along_transposed(const T* const* row, int rows, const AlongTap<T>* taps,
                                              int radius, T* const* out, std::ptrdiff_t plane) {
    for (int y = 0; y < rows; ++y, ++row) {
      V m0[vectors], m1[vectors], m2[vectors], m3[vectors];
      for (int v = 0; v < vectors; ++v) {
        const T* const c = row[0] + v * lanes;
        V g;
        load(g, c + columns);
        m3[v] = g * taps[0].e0;
        m1[v] = g * taps[0].e2_mix;
        load(g, c + 2 * columns);
        m0[v] = g * taps[0].e2;
        load(g, c + 4 * columns);
        m2[v] = g * taps[0].e0;
      }
      for (int k = 1; k <= radius; ++k) {
        const T *const up = row[k], *const down = row[-k];
        const AlongTap<T>& t = taps[k];
        for (int v = 0; v < vectors; ++v) {
          V a, b;
          load(a, up + v * lanes);
          load(b, down + v * lanes);
          const V difference = b - a;   // odd factors change their sign
          m0[v] += difference * t.o3;
          m2[v] += difference * t.o1_mix;
        }
        for (int v = 0; v < vectors; ++v) {
          V a, b;
          load(a, up + columns + v * lanes);
          load(b, down + columns + v * lanes);
          const V sum = a + b;
          m3[v] += sum * t.e0;
          m1[v] += sum * t.e2_mix;
        }
        for (int v = 0; v < vectors; ++v) {
          V a, b;
          load(a, up + 2 * columns + v * lanes);
          load(b, down + 2 * columns + v * lanes);
          m0[v] += (a + b) * t.e2;
        }
        for (int v = 0; v < vectors; ++v) {
          V a, b;
          load(a, up + 3 * columns + v * lanes);
          load(b, down + 3 * columns + v * lanes);
          m1[v] += (b - a) * t.o1;
        }
        for (int v = 0; v < vectors; ++v) {
          V a, b;
          load(a, up + 4 * columns + v * lanes);
          load(b, down + 4 * columns + v * lanes);
          m2[v] += (a + b) * t.e0;
        }
      }
      T* const to = out[y];
      for (int v = 0; v < vectors; ++v) {
        add(to + v * lanes, m0[v]);
        add(to + plane + v * lanes, m1[v]);
        add(to + 2 * plane + v * lanes, m2[v]);
        add(to + 3 * plane + v * lanes, m3[v]);
      }
    }
  }

  SEMSURF_INLINE static void across_transposed(const T* moment, std::ptrdiff_t plane, int count,
                                               const AcrossTap<T>* taps, int radius, T* out) {
    for (int x = 0; x < count; x += columns) {
      const T* const c = moment + x;
      V sum[vectors];
      for (int v = 0; v < vectors; ++v) {
        V m0, m2;
        load(m0, c + v * lanes);
        load(m2, c + 2 * plane + v * lanes);
        sum[v] = m0 * taps[0].e0 + m2 * taps[0].e2;
      }
      // Two sums each, so that they need not wait for one another.
      V odd[vectors] = {};
      for (int k = 1; k <= radius; ++k) {
        const AcrossTap<T> t = taps[k];
        for (int v = 0; v < vectors; ++v) {
          const T* const p = c + v * lanes;
          V a, b;
          load(a, p + k);
          load(b, p - k);
          sum[v] += (a + b) * t.e0;
          load(a, p + plane + k);
          load(b, p + plane - k);
          odd[v] += (b - a) * t.o1;
          load(a, p + 2 * plane + k);
          load(b, p + 2 * plane - k);
          sum[v] += (a + b) * t.e2;
          load(a, p + 3 * plane + k);
          load(b, p + 3 * plane - k);
          odd[v] += (b - a) * t.o3;
        }
      }
      for (int v = 0; v < vectors; ++v) add(out + x + v * lanes, sum[v] + odd[v]);
    }
  }

  SEMSURF_INLINE static T root(T x) {
    if constexpr (sizeof(T) == sizeof(float)) return __builtin_sqrtf(x);
    else return __builtin_sqrt(x);
  }

  /// 1 / root, and 0 where the root is 0: the mean of the one-sided derivatives of a length is 0 there.
  SEMSURF_INLINE static T inverse(T length, T floor) { return length > floor ? 1 / length : T(0); }

  SEMSURF_INLINE static void invariants(const T* k, int rows, T* out) {
    for (int y = 0; y < rows; ++y, k += coefficients * columns, out += 3 * columns)
      for (int x = 0; x < columns; ++x) {
        const T k2 = k[x], k3 = k[columns + x], k4 = k[2 * columns + x], k5 = k[3 * columns + x],
                k6 = k[4 * columns + x];
        const T mean = k6 + k4, half = root((k6 - k4) * (k6 - k4) + k5 * k5);
        out[x] = root(k2 * k2 + k3 * k3);
        out[columns + x] = mean + half;
        out[2 * columns + x] = mean - half;
      }
  }

  SEMSURF_INLINE static void combine(const T* k, int rows, const Weights<T>* weights, int channels, T* sum) {
    const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(rows) * columns;
    for (int y = 0; y < rows; ++y, k += coefficients * columns, sum += columns) {
      T slope[columns], mean[columns], half[columns];
      for (int x = 0; x < columns; ++x) {
        const T k2 = k[x], k3 = k[columns + x], k4 = k[2 * columns + x], k5 = k[3 * columns + x],
                k6 = k[4 * columns + x];
        slope[x] = root(k2 * k2 + k3 * k3);
        mean[x] = k6 + k4;
        half[x] = root((k6 - k4) * (k6 - k4) + k5 * k5);
      }
      for (int c = 0; c < channels; ++c) {
        const T a = weights[c].slope, b = weights[c].max_curvature + weights[c].min_curvature,
                d = weights[c].max_curvature - weights[c].min_curvature;
        T* const to = sum + c * plane;
        for (int x = 0; x < columns; ++x) to[x] += a * slope[x] + b * mean[x] + d * half[x];
      }
    }
  }

  SEMSURF_INLINE static void pull_back(const T* k, int rows, const Floors<T>& floors,
                                       const Weights<T>* weights, int channels, const T* weight, T* out) {
    const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(rows) * columns;
    for (int y = 0; y < rows; ++y, k += coefficients * columns, out += coefficients * columns, weight += columns) {
      T a[columns] = {}, b[columns] = {}, d[columns] = {};
      for (int c = 0; c < channels; ++c) {
        const T wa = weights[c].slope, wb = weights[c].max_curvature + weights[c].min_curvature,
                wd = weights[c].max_curvature - weights[c].min_curvature;
        const T* const w = weight + c * plane;
        for (int x = 0; x < columns; ++x) {
          a[x] += wa * w[x];
          b[x] += wb * w[x];
          d[x] += wd * w[x];
        }
      }
      for (int x = 0; x < columns; ++x) {
        const T k2 = k[x], k3 = k[columns + x], k4 = k[2 * columns + x], k5 = k[3 * columns + x],
                k6 = k[4 * columns + x];
        const T slope = a[x] * inverse(root(k2 * k2 + k3 * k3), floors.slope);
        const T half = d[x] * inverse(root((k6 - k4) * (k6 - k4) + k5 * k5), floors.curvature);
        out[x] = slope * k2;
        out[columns + x] = slope * k3;
        out[2 * columns + x] = b[x] - half * (k6 - k4);
        out[3 * columns + x] = half * k5;
        out[4 * columns + x] = b[x] + half * (k6 - k4);
      }
    }
  }

  SEMSURF_INLINE static void push_forward(const T* k, const T* dk, int rows, const Floors<T>& floors,
                                          const Weights<T>* weights, int channels, T* sum) {
    const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(rows) * columns;
    for (int y = 0; y < rows; ++y, k += coefficients * columns, dk += coefficients * columns, sum += columns) {
      T slope[columns], mean[columns], half[columns];
      for (int x = 0; x < columns; ++x) {
        const T k2 = k[x], k3 = k[columns + x], k4 = k[2 * columns + x], k5 = k[3 * columns + x],
                k6 = k[4 * columns + x];
        const T d4 = dk[2 * columns + x], d6 = dk[4 * columns + x];
        slope[x] = (k2 * dk[x] + k3 * dk[columns + x]) * inverse(root(k2 * k2 + k3 * k3), floors.slope);
        mean[x] = d6 + d4;
        half[x] = ((k6 - k4) * (d6 - d4) + k5 * dk[3 * columns + x]) *
                  inverse(root((k6 - k4) * (k6 - k4) + k5 * k5), floors.curvature);
      }
      for (int c = 0; c < channels; ++c) {
        const T a = weights[c].slope, b = weights[c].max_curvature + weights[c].min_curvature,
                d = weights[c].max_curvature - weights[c].min_curvature;
        T* const to = sum + c * plane;
        for (int x = 0; x < columns; ++x) to[x] += a * slope[x] + b * mean[x] + d * half[x];
      }
    }
  }

  SEMSURF_INLINE static T largest(const T* values, std::ptrdiff_t count) {
    V most = {};
    for (std::ptrdiff_t i = 0; i + lanes <= count; i += lanes) {
      V v;
      load(v, values + i);
      v = v < 0 ? -v : v;
      most = v > most ? v : most;
    }
    T of_all = most[0];
    for (int i = 1; i < lanes; ++i) of_all = most[i] > of_all ? most[i] : of_all;
    return of_all;
  }
};

}  // namespace surf::facet
