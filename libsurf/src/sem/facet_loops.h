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
  SEMSURF_INLINE static void increase(T* p, const V& v) {
    V sum;
    load(sum, p);
    store(p, sum + v);
  }


  /// Both for a sum and a difference. Keeps GCC from loading b a second time: loads are what is short. Clang
  /// does not allow it for vectors that the file's own target lacks.
  SEMSURF_INLINE static void load_pair(V& a, V& b, const T* p, const T* q) {
    load(a, p);
    load(b, q);
#if defined(__x86_64__) && !defined(__clang__)
    asm("" : "+v"(b));
#endif
  }

  SEMSURF_INLINE static void across(const T* z, std::ptrdiff_t stride, int rows, const Tap<T>* taps,
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
        const Tap<T> t = taps[k];
        for (int v = 0; v < vectors; ++v) {
          V right, left;
          load_pair(right, left, z + v * lanes + k, z + v * lanes - k);
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

  SEMSURF_INLINE static void along(const T* const* row, int rows, const Tap<T>* taps, int radius,
                                   const Scaling<T>& scaling, T* out) {
    for (int y = 0; y < rows; ++y, ++row, out += coefficients * columns) {
      V k2[vectors], k3[vectors], k4[vectors], k5[vectors], k6[vectors];
      for (int v = 0; v < vectors; ++v) {
        const T* const c = row[0] + v * lanes;
        V m0, m1, m2, m3;
        load(m0, c);
        load(m1, c + columns);
        load(m2, c + 2 * columns);
        load(m3, c + 3 * columns);
        k4[v] = m0 * taps[0].e2;
        k3[v] = m1 * taps[0].e2 + m3 * taps[0].e0;
        k6[v] = m2 * taps[0].e0;
        k2[v] = k5[v] = V{};
      }
      for (int k = 1; k <= radius; ++k) {
        const T *const up = row[k], *const down = row[-k];
        const Tap<T> t = taps[k];
        for (int v = 0; v < vectors; ++v) {
          V a, b;
          load_pair(a, b, up + v * lanes, down + v * lanes);
          k4[v] += (a + b) * t.e2;
          k2[v] += (a - b) * t.o3;
        }
        for (int v = 0; v < vectors; ++v) {
          V a, b;
          load_pair(a, b, up + columns + v * lanes, down + columns + v * lanes);
          k3[v] += (a + b) * t.e2;
          k5[v] += (a - b) * t.o1;
        }
        for (int v = 0; v < vectors; ++v) {
          V a, b;
          load_pair(a, b, up + 2 * columns + v * lanes, down + 2 * columns + v * lanes);
          k6[v] += (a + b) * t.e0;
          k2[v] += (a - b) * t.o1;
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
        store(out + 3 * columns + v * lanes, k5[v] * scaling.k5);
        store(out + 4 * columns + v * lanes, k6[v] * scaling.k6);
      }
    }
  }

  SEMSURF_INLINE static void along_transposed(const T* const* row, int rows, const Tap<T>* taps, int begin,
                                              int radius, bool add, T* const* out, std::ptrdiff_t plane) {
    for (int y = 0; y < rows; ++y, ++row) {
      T* const to = out[y];
      V m0[vectors], m1[vectors], m2[vectors], m3[vectors];
      for (int v = 0; v < vectors; ++v) {
        const T* const c = row[0] + v * lanes;
        V g3, g4, g6;
        load(g3, c + columns);
        load(g4, c + 2 * columns);
        load(g6, c + 4 * columns);
        m0[v] = g4 * taps[0].e2;
        m1[v] = g3 * taps[0].e2;
        m2[v] = g6 * taps[0].e0;
        m3[v] = g3 * taps[0].e0;
      }
      for (int k = begin; k <= radius; ++k) {
        const T *const up = row[k], *const down = row[-k];
        const Tap<T> t = taps[k];
        for (int v = 0; v < vectors; ++v) {
          V a, b;
          load(a, up + v * lanes);
          load(b, down + v * lanes);
          const V difference = b - a;   // odd factors change their sign
          m0[v] += difference * t.o3;
          m2[v] += difference * t.o1;
        }
        for (int v = 0; v < vectors; ++v) {
          V a, b;
          load(a, up + columns + v * lanes);
          load(b, down + columns + v * lanes);
          const V sum = a + b;
          m3[v] += sum * t.e0;
          m1[v] += sum * t.e2;
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
      for (int v = 0; v < vectors; ++v) {
        T* const p = to + v * lanes;
        if (add) {
          increase(p, m0[v]);
          increase(p + plane, m1[v]);
          increase(p + 2 * plane, m2[v]);
          increase(p + 3 * plane, m3[v]);
        } else {
          store(p, m0[v]);
          store(p + plane, m1[v]);
          store(p + 2 * plane, m2[v]);
          store(p + 3 * plane, m3[v]);
        }
      }
    }
  }

  SEMSURF_INLINE static void across_transposed(const T* moment, std::ptrdiff_t plane, int count,
                                               const Tap<T>* taps, int radius, T* out) {
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
        const Tap<T> t = taps[k];
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
      for (int v = 0; v < vectors; ++v) increase(out + x + v * lanes, sum[v] + odd[v]);
    }
  }

  SEMSURF_INLINE static void take_root(V& x) {
    T each[lanes];
    __builtin_memcpy(each, &x, sizeof x);
    for (T& value : each) {
      if constexpr (sizeof(T) == sizeof(float)) value = __builtin_sqrtf(value);
      else value = __builtin_sqrt(value);
    }
    __builtin_memcpy(&x, each, sizeof x);
  }

  /// 1 / root, and 0 where the root is 0: the mean of the one-sided derivatives of a length is 0 there.
  SEMSURF_INLINE static void invert(V& length, T floor) { length = length > floor ? 1 / length : V{}; }

  /// The coefficients of some pixels, and the roots of their invariants.
  struct Pixels {
    V k2, k3, k4, k5, k6;

    [[gnu::always_inline]] explicit Pixels(const T* k) {
      load(k2, k);
      load(k3, k + columns);
      load(k4, k + 2 * columns);
      load(k5, k + 3 * columns);
      load(k6, k + 4 * columns);
    }
    SEMSURF_INLINE void roots(V& slope, V& half_difference) const {
      slope = k2 * k2 + k3 * k3;
      half_difference = (k6 - k4) * (k6 - k4) + k5 * k5;
      take_root(slope);
      take_root(half_difference);
    }
  };

  /// Adds a channel's share of a scale.
  SEMSURF_INLINE static void add_channels(const V& slope, const V& mean, const V& half, const Weights<T>* weights,
                                          int channels, std::ptrdiff_t plane, T* sum) {
    for (int c = 0; c < channels; ++c) {
      const Weights<T> w = weights[c];
      increase(sum + c * plane, slope * w.slope + mean * (w.max_curvature + w.min_curvature) +
                                    half * (w.max_curvature - w.min_curvature));
    }
  }

  SEMSURF_INLINE static void invariants(const T* k, int rows, T* out) {
    for (int y = 0; y < rows; ++y, k += coefficients * columns, out += 3 * columns)
      for (int x = 0; x < columns; x += lanes) {
        const Pixels p(k + x);
        const V mean = p.k6 + p.k4;
        V slope, half;
        p.roots(slope, half);
        store(out + x, slope);
        store(out + columns + x, mean + half);
        store(out + 2 * columns + x, mean - half);
      }
  }

  SEMSURF_INLINE static void combine(const T* k, int rows, const Weights<T>* weights, int channels, T* sum) {
    const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(rows) * columns;
    for (int y = 0; y < rows; ++y, k += coefficients * columns, sum += columns)
      for (int x = 0; x < columns; x += lanes) {
        const Pixels p(k + x);
        V slope, half;
        p.roots(slope, half);
        add_channels(slope, p.k6 + p.k4, half, weights, channels, plane, sum + x);
      }
  }

  SEMSURF_INLINE static void pull_back(const T* k, int rows, const Floors<T>& floors, const Weights<T>* weights,
                                       int channels, const T* weight, T* out) {
    const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(rows) * columns;
    for (int y = 0; y < rows; ++y, k += coefficients * columns, out += coefficients * columns, weight += columns)
      for (int x = 0; x < columns; x += lanes) {
        V slope = {}, mean = {}, half = {};
        for (int c = 0; c < channels; ++c) {
          const Weights<T> f = weights[c];
          V w;
          load(w, weight + c * plane + x);
          slope += w * f.slope;
          mean += w * (f.max_curvature + f.min_curvature);
          half += w * (f.max_curvature - f.min_curvature);
        }
        const Pixels p(k + x);
        V length, difference;
        p.roots(length, difference);
        invert(length, floors.slope);
        invert(difference, floors.curvature);
        slope *= length;
        half *= difference;
        const V tilt = half * (p.k6 - p.k4);
        store(out + x, slope * p.k2);
        store(out + columns + x, slope * p.k3);
        store(out + 2 * columns + x, mean - tilt);
        store(out + 3 * columns + x, half * p.k5);
        store(out + 4 * columns + x, mean + tilt);
      }
  }

  SEMSURF_INLINE static void push_forward(const T* k, const T* dk, int rows, const Floors<T>& floors,
                                          const Weights<T>* weights, int channels, T* sum) {
    const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(rows) * columns;
    for (int y = 0; y < rows; ++y, k += coefficients * columns, dk += coefficients * columns, sum += columns)
      for (int x = 0; x < columns; x += lanes) {
        const Pixels p(k + x), d(dk + x);
        V slope, half;
        p.roots(slope, half);
        invert(slope, floors.slope);
        invert(half, floors.curvature);
        slope *= p.k2 * d.k2 + p.k3 * d.k3;
        half *= (p.k6 - p.k4) * (d.k6 - d.k4) + p.k5 * d.k5;
        add_channels(slope, d.k6 + d.k4, half, weights, channels, plane, sum + x);
      }
  }

  SEMSURF_INLINE static void relative(const double* z, int count, double level, T* out) {
    for (int i = 0; i < count; ++i) out[i] = static_cast<T>(z[i] - level);
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
