// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled once for each instruction set (core/each_target.h). Everything is inlined into functions
// for that instruction set; nothing of the standard library is called.
#include <utility>

#include "core/each_target.h"
#include "sem/facet/facet_operations.h"

#if defined(SURF_FACET_LOOPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SURF_FACET_LOOPS_INL_H
#undef SURF_FACET_LOOPS_INL_H
#else
#define SURF_FACET_LOOPS_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace surf::facet::HWY_NAMESPACE {

/// Vectors that are computed together: they share what is broadcast, and all sums stay in
/// registers.
constexpr int vectors = 2;

template <class T>
struct Loops {
  typedef T V [[gnu::vector_size(SEMSURF_VECTOR_BYTES)]];
  static constexpr int lanes = SEMSURF_VECTOR_BYTES / static_cast<int>(sizeof(T));
  static constexpr int columns = vectors * lanes;

  HWY_INLINE static void load(V& v, const T* p) { __builtin_memcpy(&v, p, sizeof v); }
  HWY_INLINE static void store(T* p, const V& v) { __builtin_memcpy(p, &v, sizeof v); }
  HWY_INLINE static void increase(T* p, const V& v) {
    V sum;
    load(sum, p);
    store(p, sum + v);
  }

  /// Loads two vectors for a sum and a difference. Keeps GCC from loading b a second time, because
  /// loads are the bottleneck. Clang does not allow this for vectors that the file's own target
  /// lacks.
  HWY_INLINE static void load_pair(V& a, V& b, const T* p, const T* q) {
    load(a, p);
    load(b, q);
#if defined(__x86_64__) && !defined(__clang__)
    asm("" : "+v"(b));
#endif
  }

  HWY_INLINE static void across(const T* z, std::ptrdiff_t stride, int rows, const Tap<T>* taps,
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

  /// A vector for each of two neighbouring rows of results. All but one of the rows that they need
  /// on each side are common.
  struct Rows {
    V row[2] = {};

    HWY_INLINE void operator+=(const Rows& other) {
      row[0] += other.row[0];
      row[1] += other.row[1];
    }
    HWY_INLINE void operator-=(const Rows& other) {
      row[0] -= other.row[0];
      row[1] -= other.row[1];
    }
  };

  HWY_INLINE static Rows times(const T* p, std::ptrdiff_t stride, T factor) {
    Rows rows;
    load_pair(rows.row[0], rows.row[1], p, p + stride);
    rows.row[0] *= factor;
    rows.row[1] *= factor;
    return rows;
  }

  /// Calls use(tap, k % 2, row, above, below) with the vectors k rows above and below each of both
  /// rows, for k from `begin` on. Each vector is loaded once: it is used for one row, and for the
  /// other row a step later.
  template <class Use>
  HWY_INLINE static void each_pair(const T* p, std::ptrdiff_t stride, const Tap<T>* taps, int begin,
                                   int radius, const Use& use) {
    V above[2], below[2];
    load_pair(above[0], below[0], p + begin * stride, p + (1 - begin) * stride);
    const auto step = [&](int k, int phase) HWY_ATTR __attribute__((always_inline)) {
      load_pair(above[1 - phase], below[1 - phase], p + (k + 1) * stride, p - k * stride);
      use(taps[k], phase, 0, above[phase], below[1 - phase]);
      use(taps[k], phase, 1, above[1 - phase], below[phase]);
    };
    int k = begin;
    for (; k < radius; k += 2) {
      step(k, 0);
      step(k + 1, 1);
    }
    if (k == radius) step(k, 0);
  }

  /// Filters sums (sign 1) or differences of samples above and below by a factor. The sum is split
  /// in two halves, so that additions need not wait for one another.
  template <auto Factor, int Sign>
  HWY_INLINE static Rows filtered(const T* p, std::ptrdiff_t stride, const Tap<T>* taps, int begin,
                                  int radius) {
    Rows half[2];
    each_pair(
        p, stride, taps, begin, radius,
        [&](const Tap<T>& t, int phase, int row, const V& above, const V& below) HWY_ATTR
        __attribute__((always_inline)) {
          half[phase].row[row] += (Sign > 0 ? above + below : above - below) * (t.*Factor);
        });
    half[0] += half[1];
    return half[0];
  }

  /// Filters by two factors at once; adds to `first` and `second`.
  template <auto First, int FirstSign, auto Second, int SecondSign>
  HWY_INLINE static void add_filtered(const T* p, std::ptrdiff_t stride, const Tap<T>* taps,
                                      int begin, int radius, Rows& first, Rows& second) {
    Rows a[2], b[2];
    each_pair(
        p, stride, taps, begin, radius,
        [&](const Tap<T>& t, int phase, int row, const V& above, const V& below) HWY_ATTR
        __attribute__((always_inline)) {
          a[phase].row[row] += (FirstSign > 0 ? above + below : above - below) * (t.*First);
          b[phase].row[row] += (SecondSign > 0 ? above + below : above - below) * (t.*Second);
        });
    a[0] += a[1];
    b[0] += b[1];
    first += a[0];
    second += b[0];
  }

  HWY_INLINE static void store_rows(T* p, std::ptrdiff_t stride, const Rows& rows, T factor = 1) {
    store(p, rows.row[0] * factor);
    store(p + stride, rows.row[1] * factor);
  }

  HWY_INLINE static void along(const T* moment, int rows, const Tap<T>* taps, int radius,
                               const Scaling<T>& scaling, T* out) {
    using F = Tap<T>;
    constexpr std::ptrdiff_t stride = moments * columns, out_stride = coefficients * columns;
    const F& t = taps[0];
    for (int y = 0; y < rows; y += 2, moment += 2 * stride, out += 2 * out_stride)
      for (int x = 0; x < columns; x += lanes) {
        const T *const m0 = moment + x, *const m1 = m0 + columns, *const m2 = m1 + columns,
                       *const m3 = m2 + columns;
        Rows k2, k4 = times(m0, stride, t.e2);
        add_filtered<&F::e2, 1, &F::o3, -1>(m0, stride, taps, 1, radius, k4, k2);
        store_rows(out + x + 2 * columns, out_stride, k4);
        Rows k6 = times(m2, stride, t.e0);
        add_filtered<&F::e0, 1, &F::o1, -1>(m2, stride, taps, 1, radius, k6, k2);
        store_rows(out + x, out_stride, k2);
        store_rows(out + x + 4 * columns, out_stride, k6, scaling.k6);
        Rows k5, k3 = times(m1, stride, t.e2);
        add_filtered<&F::e2, 1, &F::o1, -1>(m1, stride, taps, 1, radius, k3, k5);
        store_rows(out + x + 3 * columns, out_stride, k5, scaling.k5);
        k3 += times(m3, stride, t.e0);
        k3 += filtered<&F::e0, 1>(m3, stride, taps, 1, radius);
        store_rows(out + x + columns, out_stride, k3);
      }
  }

  HWY_INLINE static void along_transposed(const T* weight, int rows, const Tap<T>* taps, int begin,
                                          int radius, bool add, T* const* out,
                                          std::ptrdiff_t plane) {
    using F = Tap<T>;
    constexpr std::ptrdiff_t stride = coefficients * columns;
    const F& t = taps[0];
    for (int y = 0; y < rows; y += 2, weight += 2 * stride, out += 2)
      for (int x = 0; x < columns; x += lanes) {
        const auto put = [&](std::ptrdiff_t at, const Rows& moment) HWY_ATTR
            __attribute__((always_inline)) {
          for (int row = 0; row < 2 && y + row < rows; ++row) {
            if (add) increase(out[row] + at + x, moment.row[row]);
            else store(out[row] + at + x, moment.row[row]);
          }
        };
        const T *const g2 = weight + x, *const g3 = g2 + columns, *const g4 = g3 + columns,
                       *const g5 = g4 + columns, *const g6 = g5 + columns;
        // Odd factors change sign.
        Rows odd0, odd2;
        add_filtered<&F::o3, -1, &F::o1, -1>(g2, stride, taps, begin, radius, odd0, odd2);
        Rows m0 = times(g4, stride, t.e2);
        m0 += filtered<&F::e2, 1>(g4, stride, taps, begin, radius);
        m0 -= odd0;
        put(0, m0);
        Rows m2 = times(g6, stride, t.e0);
        m2 += filtered<&F::e0, 1>(g6, stride, taps, begin, radius);
        m2 -= odd2;
        put(2 * plane, m2);
        Rows m1 = times(g3, stride, t.e2), m3 = times(g3, stride, t.e0);
        add_filtered<&F::e0, 1, &F::e2, 1>(g3, stride, taps, begin, radius, m3, m1);
        put(3 * plane, m3);
        m1 -= filtered<&F::o1, -1>(g5, stride, taps, begin, radius);
        put(plane, m1);
      }
  }

  /// Transposes a square of vectors, in log2(lanes) steps that exchange halves of pairs, quarters,
  /// and so on.
  template <int Step, int... I>
  HWY_INLINE static void exchange(V& a, V& b, std::integer_sequence<int, I...>) {
    const V low = __builtin_shufflevector(a, b, (I & Step ? lanes + I - Step : I)...);
    b = __builtin_shufflevector(a, b, (I & Step ? lanes + I : I + Step)...);
    a = low;
  }
  template <int Step = lanes / 2>
  HWY_INLINE static void transpose(V (&rows)[lanes]) {
    if constexpr (Step > 0) {
      for (int i = 0; i < lanes; ++i)
        if (!(i & Step))
          exchange<Step>(rows[i], rows[i + Step], std::make_integer_sequence<int, lanes>());
      transpose<Step / 2>(rows);
    }
  }

  HWY_INLINE static void turn(const T* plane, std::ptrdiff_t stride, int count,
                              std::ptrdiff_t out_stride, T* out) {
    for (int x = 0; x < count; x += lanes)
      for (int part = 0; part < vectors; ++part) {
        V rows[lanes];
        for (int i = 0; i < lanes; ++i) load(rows[i], plane + (part * lanes + i) * stride + x);
        transpose(rows);
        for (int i = 0; i < lanes; ++i) store(out + (x + i) * out_stride + part * lanes, rows[i]);
      }
  }

  HWY_INLINE static void across_transposed(const T* moment, int count, const Tap<T>* taps,
                                           int radius, T* sum) {
    using F = Tap<T>;
    constexpr std::ptrdiff_t stride = moments * columns;
    for (int i = 0; i < count; i += 2, moment += 2 * stride, sum += 2 * columns)
      for (int x = 0; x < columns; x += lanes) {
        const T *const m0 = moment + x, *const m1 = m0 + columns, *const m2 = m1 + columns,
                       *const m3 = m2 + columns;
        Rows total = times(m0, stride, taps[0].e0);
        total += times(m2, stride, taps[0].e2);
        total += filtered<&F::e0, 1>(m0, stride, taps, 1, radius);
        total += filtered<&F::e2, 1>(m2, stride, taps, 1, radius);
        total -= filtered<&F::o1, -1>(m1, stride, taps, 1, radius);
        total -= filtered<&F::o3, -1>(m3, stride, taps, 1, radius);
        increase(sum + x, total.row[0]);
        increase(sum + columns + x, total.row[1]);
      }
  }

  HWY_INLINE static void take_root(V& x) {
    T each[lanes];
    __builtin_memcpy(each, &x, sizeof x);
    for (T& value : each) {
      if constexpr (sizeof(T) == sizeof(float)) value = __builtin_sqrtf(value);
      else value = __builtin_sqrt(value);
    }
    __builtin_memcpy(&x, each, sizeof x);
  }

  /// 1 / length, or 0 if the length is 0, because the mean of the one-sided derivatives of a length
  /// is 0 there.
  HWY_INLINE static void invert(V& length, T floor) { length = length > floor ? 1 / length : V{}; }

  /// The coefficients of some pixels, and the roots in their invariants.
  struct Pixels {
    V k2, k3, k4, k5, k6;

    HWY_INLINE explicit Pixels(const T* k) {
      load(k2, k);
      load(k3, k + columns);
      load(k4, k + 2 * columns);
      load(k5, k + 3 * columns);
      load(k6, k + 4 * columns);
    }
    HWY_INLINE void roots(V& slope, V& half_difference) const {
      slope = k2 * k2 + k3 * k3;
      half_difference = (k6 - k4) * (k6 - k4) + k5 * k5;
      take_root(slope);
      take_root(half_difference);
    }
  };

  /// Adds the contribution of a scale to all channels.
  HWY_INLINE static void add_channels(const V& slope, const V& mean, const V& half,
                                      const Weights<T>* weights, int channels, std::ptrdiff_t plane,
                                      T* sum) {
    for (int c = 0; c < channels; ++c) {
      const Weights<T> w = weights[c];
      increase(sum + c * plane, slope * w.slope + mean * (w.max_curvature + w.min_curvature) +
                                    half * (w.max_curvature - w.min_curvature));
    }
  }

  HWY_INLINE static void invariants(const T* k, int rows, T* out) {
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

  HWY_INLINE static void combine(const T* k, int rows, const Weights<T>* weights, int channels,
                                 T* sum) {
    const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(rows) * columns;
    for (int y = 0; y < rows; ++y, k += coefficients * columns, sum += columns)
      for (int x = 0; x < columns; x += lanes) {
        const Pixels p(k + x);
        V slope, half;
        p.roots(slope, half);
        add_channels(slope, p.k6 + p.k4, half, weights, channels, plane, sum + x);
      }
  }

  HWY_INLINE static void pull_back(const T* k, int rows, const Floors<T>& floors,
                                   const Weights<T>* weights, int channels, const T* weight,
                                   T* out) {
    const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(rows) * columns;
    for (int y = 0; y < rows;
         ++y, k += coefficients * columns, out += coefficients * columns, weight += columns)
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

  HWY_INLINE static void push_forward(const T* k, const T* dk, int rows, const Floors<T>& floors,
                                      const Weights<T>* weights, int channels, T* sum) {
    const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(rows) * columns;
    for (int y = 0; y < rows;
         ++y, k += coefficients * columns, dk += coefficients * columns, sum += columns)
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

  /// arctan of x >= 0, to 2e-16 (the rational function of Moshier's Cephes library, with x reduced
  /// to below 0.66). Without branches, so that it can be vectorised.
  HWY_INLINE static double arc_tangent(double x) {
    const bool large = x > 2.414213562373095, middle = x > 0.66;
    const double u = (large    ? -1
                      : middle ? x - 1
                               : x) /
                     (large    ? x
                      : middle ? x + 1
                               : 1),
                 v = u * u;
    const double p = (((-0.8750608600031904 * v - 16.15753718733365) * v - 75.00855792314705) * v -
                      122.8866684490136) *
                         v -
                     64.85021904942025;
    const double q =
        ((((v + 24.85846490142306) * v + 165.0270098316988) * v + 432.8810604912903) * v +
         485.3903996359137) *
            v +
        194.5506571482614;
    return (large ? 1.5707963267948966 : middle ? 0.7853981633974483 : 0) + (u + u * v * p / q);
  }

  HWY_INLINE static void angles(const T* k, int rows, double* tangent, double* secant,
                                double* angle) {
    for (int y = 0; y < rows; ++y, k += coefficients * columns)
      for (int x = 0; x < columns; ++x) {
        const double k2 = k[x], k3 = k[columns + x], square = k2 * k2 + k3 * k3,
                     slope = __builtin_sqrt(square);
        const int i = y * columns + x;
        tangent[i] = slope;
        secant[i] = __builtin_sqrt(1 + square);
        angle[i] = arc_tangent(slope);
      }
  }

  HWY_INLINE static void spread(const T* samples, int count, const T* worth, T* out) {
    V sum[vectors] = {};
    for (int i = 0; i < count; ++i)
      for (int v = 0; v < vectors; ++v) {
        V w;
        load(w, worth + i * columns + v * lanes);
        sum[v] += w * samples[i];
      }
    for (int v = 0; v < vectors; ++v) store(out + v * lanes, sum[v]);
  }

  HWY_INLINE static void spread_transposed(const T* weight, int count, const T* worth, T* samples) {
    for (int i = 0; i < count; ++i) {
      V products = {};
      for (int v = 0; v < vectors; ++v) {
        V a, b;
        load_pair(a, b, weight + v * lanes, worth + i * columns + v * lanes);
        products += a * b;
      }
      T sum = 0;
      for (int j = 0; j < lanes; ++j) sum += products[j];
      samples[i] += sum;
    }
  }

  HWY_INLINE static void between_rows(const T* samples, int first, int step, int rows, T* out) {
    constexpr int size = coefficients * columns;
    for (int y = 0; y < rows; ++y, out += size) {
      const T* const low = samples + (first + y) / step * size;
      const T fraction = static_cast<T>((first + y) % step) / static_cast<T>(step);
      for (int x = 0; x < size; x += lanes) {
        V a, b;
        load_pair(a, b, low + x, low + size + x);
        store(out + x, a + (b - a) * fraction);
      }
    }
  }

  HWY_INLINE static void between_rows_transposed(const T* weight, int first, int step, int rows,
                                                 T* samples) {
    constexpr int size = coefficients * columns;
    for (int y = 0; y < rows; ++y, weight += size) {
      T* const low = samples + (first + y) / step * size;
      const T fraction = static_cast<T>((first + y) % step) / static_cast<T>(step);
      for (int x = 0; x < size; x += lanes) {
        V w;
        load(w, weight + x);
        increase(low + size + x, w * fraction);
        increase(low + x, w * (1 - fraction));
      }
    }
  }

  HWY_INLINE static void relative(const double* z, int count, double level, T* out) {
    for (int i = 0; i < count; ++i) out[i] = static_cast<T>(z[i] - level);
  }

  HWY_INLINE static T largest(const T* values, std::ptrdiff_t count) {
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

}  // namespace surf::facet::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
