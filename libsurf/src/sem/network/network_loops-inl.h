// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled once for each instruction set, like facet_loops-inl.h.
#include "core/each_target.h"
#include "sem/network/network_operations.h"

#if defined(SURF_NETWORK_LOOPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SURF_NETWORK_LOOPS_INL_H
#undef SURF_NETWORK_LOOPS_INL_H
#else
#define SURF_NETWORK_LOOPS_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace surf::network::HWY_NAMESPACE {

template <class T>
struct Loops {
  static constexpr int columns = 2 * SEMSURF_VECTOR_BYTES / static_cast<int>(sizeof(T));
  static constexpr T hidden_sky = T(0.9);  // below 1, so that its logarithm has a derivative

  HWY_INLINE static T root(T x) {
    if constexpr (sizeof(T) == sizeof(float)) return __builtin_sqrtf(x);
    else return __builtin_sqrt(x);
  }

  /// max(x, 0) without a comparison, which would prevent vectorisation.
  HWY_INLINE static T positive(T x) {
    if constexpr (sizeof(T) == sizeof(float)) return T(0.5) * (x + __builtin_fabsf(x));
    else return T(0.5) * (x + __builtin_fabs(x));
  }

  /// The quantities from which a scale's inputs at a pixel are computed.
  struct Facet {
    T gg, r, mean, mean_r, split, difference, along, along_r;  // r: fourth roots of 1 + square
  };
  HWY_INLINE static Facet facet(T k2, T k3, T k4, T k5, T k6, T length) {
    Facet f;
    f.gg = k2 * k2 + k3 * k3;
    f.r = root(root(1 + f.gg));
    f.mean = (k6 + k4) * length;
    f.mean_r = root(root(1 + f.mean * f.mean));
    f.difference = (k6 - k4) * length;
    const T mixed = k5 * length;
    f.split = root(root(1 + f.difference * f.difference + mixed * mixed));
    f.along = (k3 * k3 * k6 + k3 * k2 * k5 + k2 * k2 * k4) * length / (1 + f.gg);
    f.along_r = root(root(1 + f.along * f.along));
    return f;
  }
  /// The derivative of c(x) = x / r, r = (1 + x^2)^(1/4).
  HWY_INLINE static T slope(T x, T r) { return (1 + T(0.5) * x * x) / ((1 + x * x) * r); }

  HWY_INLINE static void facets(const T* k, int rows, T length, T* out, std::ptrdiff_t stride) {
    for (int y = 0; y < rows; ++y, k += facet::coefficients * columns, out += stride)
      for (int x = 0; x < columns; ++x) {
        const Facet f = facet(k[x], k[columns + x], k[2 * columns + x], k[3 * columns + x],
                              k[4 * columns + x], length);
        out[x] = f.r - 1;
        out[columns + x] = f.mean / f.mean_r;
        out[2 * columns + x] = f.split - 1;
        out[3 * columns + x] = f.along / f.along_r;
      }
  }

  /// Derivatives of the four inputs by the quantities in Facet: |g|^2, trace, and the two parts of
  /// the difference.
  struct Slopes {
    T gg, mean, difference, mixed, along;
  };
  HWY_INLINE static Slopes slopes(const Facet& f, T mixed) {
    const T split3 = f.split * f.split * f.split;
    return {T(0.25) / (f.r * f.r * f.r), slope(f.mean, f.mean_r), T(0.5) * f.difference / split3,
            T(0.5) * mixed / split3, slope(f.along, f.along_r)};
  }

  HWY_INLINE static void facets_back(const T* k, int rows, T length, const T* weight,
                                     std::ptrdiff_t stride, T* out) {
    for (int y = 0; y < rows; ++y, k += facet::coefficients * columns, weight += stride,
             out += facet::coefficients * columns)
      for (int x = 0; x < columns; ++x) {
        const T k2 = k[x], k3 = k[columns + x], k4 = k[2 * columns + x], k5 = k[3 * columns + x],
                k6 = k[4 * columns + x];
        const Facet f = facet(k2, k3, k4, k5, k6, length);
        const Slopes s = slopes(f, k5 * length);
        const T mean = weight[columns + x] * s.mean * length;
        const T difference = weight[2 * columns + x] * s.difference * length;
        const T along = weight[3 * columns + x] * s.along / (1 + f.gg);
        const T gg = 2 * (weight[x] * s.gg - along * f.along), quadratic = along * length;
        out[x] = gg * k2 + quadratic * (k3 * k5 + 2 * k2 * k4);
        out[columns + x] = gg * k3 + quadratic * (k2 * k5 + 2 * k3 * k6);
        out[2 * columns + x] = mean - difference + quadratic * k2 * k2;
        out[3 * columns + x] = weight[2 * columns + x] * s.mixed * length + quadratic * k3 * k2;
        out[4 * columns + x] = mean + difference + quadratic * k3 * k3;
      }
  }

  HWY_INLINE static void facets_change(const T* k, const T* dk, int rows, T length, T* out,
                                       std::ptrdiff_t stride) {
    for (int y = 0; y < rows; ++y, k += facet::coefficients * columns,
             dk += facet::coefficients * columns, out += stride)
      for (int x = 0; x < columns; ++x) {
        const T k2 = k[x], k3 = k[columns + x], k4 = k[2 * columns + x], k5 = k[3 * columns + x],
                k6 = k[4 * columns + x];
        const T d2 = dk[x], d3 = dk[columns + x], d4 = dk[2 * columns + x],
                d5 = dk[3 * columns + x], d6 = dk[4 * columns + x];
        const Facet f = facet(k2, k3, k4, k5, k6, length);
        const Slopes s = slopes(f, k5 * length);
        const T dgg = 2 * (k2 * d2 + k3 * d3);
        const T quadratic = d3 * (k2 * k5 + 2 * k3 * k6) + d2 * (k3 * k5 + 2 * k2 * k4) +
                            k3 * k3 * d6 + k3 * k2 * d5 + k2 * k2 * d4;
        out[x] = s.gg * dgg;
        out[columns + x] = s.mean * length * (d6 + d4);
        out[2 * columns + x] = length * (s.difference * (d6 - d4) + s.mixed * d5);
        out[3 * columns + x] = s.along * (length * quadratic - f.along * dgg) / (1 + f.gg);
      }
  }

  HWY_INLINE static void sky(const T* z, const SkySample<T>* samples, int count, int bands,
                             T* out) {
    for (int i = 0; i < (2 * bands + 1) * columns; ++i) out[i] = 0;
    T* const open = out + 2 * bands * columns;
    T seen[columns];
    for (int x = 0; x < columns; ++x) seen[x] = T(1) / 16;
    for (int i = 0; i < count; ++i) {
      const SkySample<T>& a = samples[i];
      const T* const far = z + a.offset;
      T *const mean = out + 2 * a.band * columns, *const square = mean + columns;
      for (int x = 0; x < columns; ++x) {
        const T e = (far[x] - z[x]) * a.per_distance, s = e / root(1 + e * e), up = positive(s);
        mean[x] += a.weight * s;
        square[x] += a.weight * s * s;
        seen[x] *= 1 - hidden_sky * up * up;
      }
      if (!a.last) continue;
      for (int x = 0; x < columns; ++x) {
        open[x] += seen[x];
        seen[x] = T(1) / 16;
      }
    }
  }

  HWY_INLINE static void sky_back(const T* z, const SkySample<T>* samples, int count, int bands,
                                  const T* weight, T* dz, const std::ptrdiff_t* to, T* work) {
    const T* const open = weight + 2 * bands * columns;
    T* const kept = work + count * columns;  // roots of the direction at hand
    for (int first = 0; first < count;) {
      T seen[columns];
      for (int x = 0; x < columns; ++x) seen[x] = open[x] / 16;
      int end = first;
      for (bool last = false; !last; ++end) {
        const SkySample<T>& a = samples[end];
        last = a.last;
        const T* const far = z + a.offset;
        T *const sines = work + end * columns, *const roots = kept + (end - first) * columns;
        for (int x = 0; x < columns; ++x) {
          const T e = (far[x] - z[x]) * a.per_distance, r = 1 / root(1 + e * e), s = e * r,
                  up = positive(s);
          seen[x] *= 1 - hidden_sky * up * up;
          sines[x] = s;
          roots[x] = r;
        }
      }
      for (int i = first; i < end; ++i) {
        const SkySample<T>& a = samples[i];
        const T* const roots = kept + (i - first) * columns;
        const T *const mean = weight + 2 * a.band * columns, *const square = mean + columns;
        T* const change = work + i * columns;
        for (int x = 0; x < columns; ++x) {
          const T s = change[x], r = roots[x], up = positive(s);
          const T ds = a.weight * (mean[x] + 2 * s * square[x]) -
                       seen[x] * 2 * hidden_sky * up / (1 - hidden_sky * up * up);
          change[x] = ds * r * r * r * a.per_distance;
        }
      }
      first = end;
    }
    // Samples of one direction lie in few rows and overlap, so that an addition would wait for the
    // one before. Therefore one sample of each direction is handled after the other.
    const int apart = count / 16;
    for (int start = 0; start < apart; ++start)
      for (int i = start; i < count; i += apart) {
        const T* const change = work + i * columns;
        T* const out = dz + to[i];
        for (int x = 0; x < columns; ++x) out[x] += change[x];
      }
    for (int x = 0; x < columns; ++x) {
      T sum = 0;
      for (int i = 0; i < count; ++i) sum += work[i * columns + x];
      dz[x] -= sum;
    }
  }

  HWY_INLINE static void sky_change(const T* z, const T* dz, const SkySample<T>* samples, int count,
                                    int bands, T* out) {
    for (int i = 0; i < (2 * bands + 1) * columns; ++i) out[i] = 0;
    T* const open = out + 2 * bands * columns;
    T seen[columns], rate[columns];  // rate: derivative of the logarithm of seen
    for (int x = 0; x < columns; ++x) seen[x] = T(1) / 16, rate[x] = 0;
    for (int i = 0; i < count; ++i) {
      const SkySample<T>& a = samples[i];
      const T *const far = z + a.offset, *const dfar = dz + a.offset;
      T *const mean = out + 2 * a.band * columns, *const square = mean + columns;
      for (int x = 0; x < columns; ++x) {
        const T e = (far[x] - z[x]) * a.per_distance, r = 1 / root(1 + e * e), s = e * r,
                up = positive(s);
        const T ds = (dfar[x] - dz[x]) * a.per_distance * r * r * r,
                left = 1 - hidden_sky * up * up;
        mean[x] += a.weight * ds;
        square[x] += a.weight * 2 * s * ds;
        seen[x] *= left;
        rate[x] -= 2 * hidden_sky * up * ds / left;
      }
      if (!a.last) continue;
      for (int x = 0; x < columns; ++x) {
        open[x] += seen[x] * rate[x];
        seen[x] = T(1) / 16;
        rate[x] = 0;
      }
    }
  }

  /// sums[o] = start + sum over i of matrix[o * row + i * column] * in[i], for four outputs at a
  /// time, which share the loaded values.
  HWY_INLINE static void multiply(const T* matrix, std::ptrdiff_t row, std::ptrdiff_t column,
                                  const T* start, int inputs, int outputs, const T* in, T* out) {
    typedef T V [[gnu::vector_size(SEMSURF_VECTOR_BYTES)]];
    constexpr int lanes = columns / 2;
    int o = 0;
    for (; o + 4 <= outputs; o += 4) {
      V sum[4][2];
      for (int j = 0; j < 4; ++j) sum[j][0] = sum[j][1] = V{} + (start ? start[o + j] : T(0));
      for (int i = 0; i < inputs; ++i) {
        V a, b;
        __builtin_memcpy(&a, in + i * columns, sizeof a);
        __builtin_memcpy(&b, in + i * columns + lanes, sizeof b);
        for (int j = 0; j < 4; ++j) {
          const T w = matrix[(o + j) * row + i * column];
          sum[j][0] += a * w;
          sum[j][1] += b * w;
        }
      }
      for (int j = 0; j < 4; ++j) {
        __builtin_memcpy(out + (o + j) * columns, &sum[j][0], sizeof(V));
        __builtin_memcpy(out + (o + j) * columns + lanes, &sum[j][1], sizeof(V));
      }
    }
    for (; o < outputs; ++o) {
      T* const to = out + o * columns;
      for (int x = 0; x < columns; ++x) to[x] = start ? start[o] : T(0);
      for (int i = 0; i < inputs; ++i) {
        const T w = matrix[o * row + i * column];
        for (int x = 0; x < columns; ++x) to[x] += w * in[i * columns + x];
      }
    }
  }

  HWY_INLINE static void forward(const Layer<T>* layers, int count, const T* in, T* values,
                                 T* slopes) {
    for (int l = 0; l < count; ++l) {
      const Layer<T>& layer = layers[l];
      multiply(layer.weights, layer.inputs, 1, layer.biases, layer.inputs, layer.outputs, in,
               values);
      const int n = layer.outputs * columns;
      if (l + 1 < count)
        for (int i = 0; i < n; ++i) {
          const T r = 1 / root(1 + values[i] * values[i]);
          values[i] *= r;
          slopes[i] = r * r * r;
        }
      else
        for (int i = 0; i < n; ++i) {
          const T q = root(1 + values[i] * values[i]);
          // For large negative o the sum would lose all digits.
          values[i] = values[i] > 0 ? values[i] + q : 1 / (q - values[i]);
          slopes[i] = values[i] / q;
        }
      in = values;
      values += n;
      slopes += n;
    }
  }

  HWY_INLINE static void backward(const Layer<T>* layers, int count, const T* slopes,
                                  const T* weight, T* work, T* out) {
    std::ptrdiff_t widest = 0, at = 0;
    for (int l = 0; l < count; ++l) {
      if (layers[l].outputs > widest) widest = layers[l].outputs;
      at += layers[l].outputs;
    }
    T *a = work, *b = work + widest * columns;
    for (int l = count - 1; l >= 0; --l) {
      const Layer<T>& layer = layers[l];
      at -= layer.outputs;
      for (int i = 0; i < layer.outputs * columns; ++i) a[i] = weight[i] * slopes[at * columns + i];
      multiply(layer.weights, 1, layer.inputs, nullptr, layer.outputs, layer.inputs, a,
               l > 0 ? b : out);
      T* const product = b;
      b = a;
      a = product;
      weight = a;
    }
  }

  HWY_INLINE static void change(const Layer<T>* layers, int count, const T* slopes, const T* in,
                                T* work, T* out) {
    std::ptrdiff_t widest = 0;
    for (int l = 0; l < count; ++l)
      if (layers[l].outputs > widest) widest = layers[l].outputs;
    for (int l = 0; l < count; ++l) {
      const Layer<T>& layer = layers[l];
      T* const to = l + 1 == count ? out : work + (l % 2) * widest * columns;
      multiply(layer.weights, layer.inputs, 1, nullptr, layer.inputs, layer.outputs, in, to);
      for (int i = 0; i < layer.outputs * columns; ++i) to[i] *= slopes[i];
      slopes += layer.outputs * columns;
      in = to;
    }
  }
};

}  // namespace surf::network::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
