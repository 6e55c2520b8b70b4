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

/// `sided`: with the inputs that tell directions.
template <class T, bool sided>
struct Loops {
  typedef T V [[gnu::vector_size(SEMSURF_VECTOR_BYTES)]];
  static constexpr int lanes = SEMSURF_VECTOR_BYTES / static_cast<int>(sizeof(T));
  static constexpr int columns = 2 * lanes;
  static constexpr T hidden_sky = T(0.9);  // below 1: a part of every direction stays visible
  static constexpr int directions = 16;
  static constexpr int most_in_direction = 32;  // samples; two in each of 12 bands are fewer
  static constexpr int per_band = sky_band_inputs(sided);

  HWY_INLINE static V load(const T* p) {
    V v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
  }
  HWY_INLINE static void store(T* p, const V& v) { __builtin_memcpy(p, &v, sizeof v); }
  HWY_INLINE static void increase(T* p, const V& v) { store(p, load(p) + v); }
  HWY_INLINE static V positive(const V& x) { return x > T(0) ? x : V{}; }

  /// 1 / sqrt(x), for finite x > 0 that are not denormal. In float, a step of third
  /// order and one of second order from the bits of x: to 2e-7 of the result, in a third of the
  /// time of a root and a division. Instructions that estimate it are as fast, but give different
  /// bits on processors of different makers.
  HWY_INLINE static V inverse_root(const V& x) {
    if constexpr (sizeof(T) == sizeof(float)) {
      typedef int Bits [[gnu::vector_size(SEMSURF_VECTOR_BYTES)]];
      V y = (V)(0x5f3759df - ((Bits)x >> 1));  // to 3.5 %
      V off = 1 - x * y * y;
      y += y * off * (T(0.5) + T(0.375) * off);
      off = 1 - x * y * y;
      return y + T(0.5) * y * off;
    } else {
      V y;
      for (int i = 0; i < lanes; ++i) y[i] = 1 / __builtin_sqrt(x[i]);
      return y;
    }
  }

  /// What follows from 1 + square, without a division.
  struct Fourth {
    V inverse;       // 1 / x
    V root;          // x^(1/4)
    V inverse_root;  // x^(-1/4)

    HWY_INLINE explicit Fourth(const V& x) {
      const V y = Loops::inverse_root(x), square_root = x * y;
      inverse = y * y;
      inverse_root = Loops::inverse_root(square_root);
      root = square_root * inverse_root;
    }
    /// The derivative of c(v) = v / (1 + v^2)^(1/4), if x = 1 + v^2.
    HWY_INLINE V slope(const V& v) const { return (1 + T(0.5) * v * v) * inverse * inverse_root; }
    HWY_INLINE V cube() const { return inverse_root * inverse_root * inverse_root; }
  };

  /// The coefficients of some pixels at a scale.
  struct Coefficients {
    V k2, k3, k4, k5, k6;

    HWY_INLINE explicit Coefficients(const T* k)
        : k2(load(k)), k3(load(k + columns)), k4(load(k + 2 * columns)), k5(load(k + 3 * columns)),
          k6(load(k + 4 * columns)) {}
  };

  /// The quantities from which a scale's inputs at a pixel are computed.
  struct Facet {
    Fourth steep;
    V mean, difference, mixed, along;
    Fourth mean_root, split, along_root;

    HWY_INLINE Facet(const Coefficients& k, T length)
        : steep(1 + k.k2 * k.k2 + k.k3 * k.k3), mean((k.k6 + k.k4) * length),
          difference((k.k6 - k.k4) * length), mixed(k.k5 * length),
          along((k.k3 * k.k3 * k.k6 + k.k3 * k.k2 * k.k5 + k.k2 * k.k2 * k.k4) * length *
                steep.inverse),
          mean_root(1 + mean * mean), split(1 + difference * difference + mixed * mixed),
          along_root(1 + along * along) {}
  };

  HWY_INLINE static void facets(const T* k, int rows, T length, T* out, std::ptrdiff_t stride) {
    for (int y = 0; y < rows; ++y, k += facet::coefficients * columns, out += stride)
      for (int x = 0; x < columns; x += lanes) {
        const Facet f(Coefficients(k + x), length);
        store(out + x, f.steep.root - 1);
        store(out + columns + x, f.mean * f.mean_root.inverse_root);
        store(out + 2 * columns + x, f.split.root - 1);
        store(out + 3 * columns + x, f.along * f.along_root.inverse_root);
        if constexpr (sided) {
          const Coefficients c(k + x);
          store(out + 4 * columns + x, c.k3 * f.steep.inverse_root);
          store(out + 5 * columns + x, c.k2 * f.steep.inverse_root);
        }
      }
  }

  /// Derivatives of the four inputs by |g|^2, trace, the two parts of the difference, and the
  /// curvature along the slope.
  struct Slopes {
    V steep, mean, difference, mixed, along;

    HWY_INLINE explicit Slopes(const Facet& f)
        : steep(T(0.25) * f.steep.cube()), mean(f.mean_root.slope(f.mean)),
          along(f.along_root.slope(f.along)) {
      const V half = T(0.5) * f.split.cube();
      difference = half * f.difference;
      mixed = half * f.mixed;
    }
  };

  HWY_INLINE static void facets_back(const T* k, int rows, T length, const T* weight,
                                     std::ptrdiff_t stride, T* out) {
    for (int y = 0; y < rows; ++y, k += facet::coefficients * columns, weight += stride,
             out += facet::coefficients * columns)
      for (int x = 0; x < columns; x += lanes) {
        const Coefficients c(k + x);
        const Facet f(c, length);
        const Slopes s(f);
        const V split = load(weight + 2 * columns + x) * length;
        const V mean = load(weight + columns + x) * s.mean * length,
                difference = split * s.difference;
        const V along = load(weight + 3 * columns + x) * s.along * f.steep.inverse;
        const V gg = 2 * (load(weight + x) * s.steep - along * f.along), quadratic = along * length;
        V by_k2 = gg * c.k2 + quadratic * (c.k3 * c.k5 + 2 * c.k2 * c.k4),
          by_k3 = gg * c.k3 + quadratic * (c.k2 * c.k5 + 2 * c.k3 * c.k6);
        if constexpr (sided) {
          const V east = load(weight + 4 * columns + x), north = load(weight + 5 * columns + x);
          const V both =
              T(-0.5) * f.steep.inverse_root * f.steep.inverse * (east * c.k3 + north * c.k2);
          by_k2 += north * f.steep.inverse_root + both * c.k2;
          by_k3 += east * f.steep.inverse_root + both * c.k3;
        }
        store(out + x, by_k2);
        store(out + columns + x, by_k3);
        store(out + 2 * columns + x, mean - difference + quadratic * c.k2 * c.k2);
        store(out + 3 * columns + x, split * s.mixed + quadratic * c.k3 * c.k2);
        store(out + 4 * columns + x, mean + difference + quadratic * c.k3 * c.k3);
      }
  }

  HWY_INLINE static void facets_change(const T* k, const T* dk, int rows, T length, T* out,
                                       std::ptrdiff_t stride) {
    for (int y = 0; y < rows; ++y, k += facet::coefficients * columns,
             dk += facet::coefficients * columns, out += stride)
      for (int x = 0; x < columns; x += lanes) {
        const Coefficients c(k + x), d(dk + x);
        const Facet f(c, length);
        const Slopes s(f);
        const V dgg = 2 * (c.k2 * d.k2 + c.k3 * d.k3);
        const V quadratic = d.k3 * (c.k2 * c.k5 + 2 * c.k3 * c.k6) +
                            d.k2 * (c.k3 * c.k5 + 2 * c.k2 * c.k4) + c.k3 * c.k3 * d.k6 +
                            c.k3 * c.k2 * d.k5 + c.k2 * c.k2 * d.k4;
        store(out + x, s.steep * dgg);
        store(out + columns + x, s.mean * length * (d.k6 + d.k4));
        store(out + 2 * columns + x, length * (s.difference * (d.k6 - d.k4) + s.mixed * d.k5));
        store(out + 3 * columns + x,
              s.along * (length * quadratic - f.along * dgg) * f.steep.inverse);
        if constexpr (sided) {
          const V less = T(-0.25) * f.steep.inverse * dgg;
          store(out + 4 * columns + x, f.steep.inverse_root * (d.k3 + c.k3 * less));
          store(out + 5 * columns + x, f.steep.inverse_root * (d.k2 + c.k2 * less));
        }
      }
  }

  /// How some pixels see a sample.
  struct Sight {
    V sine;  // of its elevation
    V rate;  // the derivative of the sine by the height

    HWY_INLINE Sight(const V& near, const T* far, const SkySample<T>& sample) {
      const V rise = load(far) - near, r = inverse_root(rise * rise + sample.square);
      sine = rise * r;
      rate = sample.square * r * r * r;
    }
    /// The part of `seen` that the sample leaves open.
    HWY_INLINE V left(const V& seen) const {
      return sine > T(0) ? seen - hidden_sky * (sine * sine * seen) : seen;
    }
  };

  HWY_INLINE static void sky(const T* z, const SkySample<T>* samples, int count, int bands,
                             T* out) {
    for (int i = 0; i < sky_inputs(bands, sided) * columns; i += lanes) store(out + i, V{});
    const V near[2] = {load(z), load(z + lanes)};
    T* const open = out + per_band * bands * columns;
    for (int i = 0; i < count;) {
      V seen[2] = {V{} + T(1) / directions, V{} + T(1) / directions};
      for (bool last = false; !last;) {
        V sum[2] = {}, squares[2] = {};  // of the direction's samples in a band
        for (bool ends = false; !ends; ++i) {
          ends = samples[i].ends_band;
          last = samples[i].last;
          for (int v = 0; v < 2; ++v) {
            const Sight sight(near[v], z + v * lanes + samples[i].offset, samples[i]);
            sum[v] += sight.sine;
            squares[v] += sight.sine * sight.sine;
            seen[v] = sight.left(seen[v]);
          }
        }
        const SkySample<T>& a = samples[i - 1];
        T* const mean = out + per_band * a.band * columns;
        for (int v = 0; v < 2; ++v) {
          increase(mean + v * lanes, a.weight * sum[v]);
          increase(mean + columns + v * lanes, a.weight * squares[v]);
          if constexpr (sided) {
            increase(mean + 2 * columns + v * lanes, a.weight * a.east * sum[v]);
            increase(mean + 3 * columns + v * lanes, a.weight * a.north * sum[v]);
          }
        }
      }
      const SkySample<T>& a = samples[i - 1];
      for (int v = 0; v < 2; ++v) {
        increase(open + v * lanes, seen[v]);
        if constexpr (sided) {
          increase(open + columns + v * lanes, a.east * seen[v]);
          increase(open + 2 * columns + v * lanes, a.north * seen[v]);
        }
      }
    }
  }

  HWY_INLINE static void sky_back(const T* z, const SkySample<T>* samples, int count, int bands,
                                  const T* weight, T* dz, const std::ptrdiff_t* to, T* work) {
    const T* const open = weight + per_band * bands * columns;
    V own[2] = {};
    for (int first = 0, end = 0; first < count; first = end) {
      while (!samples[end++].last) {
      }
      for (int v = 0; v < 2; ++v) {
        const int x = v * lanes;
        const V near = load(z + x);
        // The sky left open by the samples before and behind: the product without the sample
        // itself, without a division.
        V sine[most_in_direction], rate[most_in_direction], before[most_in_direction];
        V seen = load(open + x);
        if constexpr (sided)
          seen += samples[first].east * load(open + columns + x) +
                  samples[first].north * load(open + 2 * columns + x);
        seen *= T(1) / directions;
        for (int i = first; i < end; ++i) {
          const Sight sight(near, z + x + samples[i].offset, samples[i]);
          sine[i - first] = sight.sine;
          rate[i - first] = sight.rate;
          before[i - first] = seen;
          seen = sight.left(seen);
        }
        V behind = V{} + T(1);
        for (int i = end - 1; i >= first; --i) {
          const V s = sine[i - first], up = positive(s) * hidden_sky;
          const T* const mean = weight + per_band * samples[i].band * columns + x;
          V of_band = load(mean) + 2 * s * load(mean + columns);
          if constexpr (sided)
            of_band += samples[i].east * load(mean + 2 * columns) +
                       samples[i].north * load(mean + 3 * columns);
          const V by_sine = samples[i].weight * of_band - 2 * up * (before[i - first] * behind);
          behind -= behind * up * s;
          const V change = by_sine * rate[i - first];
          store(work + i * columns + x, change);
          own[v] += change;
        }
      }
    }
    // Samples of one direction lie in few rows and overlap, so that an addition would wait for the
    // one before. Therefore one sample of each direction is handled after the other.
    const int apart = count / directions;
    for (int start = 0; start < apart; ++start)
      for (int i = start; i < count; i += apart)
        for (int x = 0; x < columns; x += lanes)
          increase(dz + to[i] + x, load(work + i * columns + x));
    for (int v = 0; v < 2; ++v) increase(dz + v * lanes, -own[v]);
  }

  HWY_INLINE static void sky_change(const T* z, const T* dz, const SkySample<T>* samples, int count,
                                    int bands, T* out) {
    for (int i = 0; i < sky_inputs(bands, sided) * columns; i += lanes) store(out + i, V{});
    T* const open = out + per_band * bands * columns;
    for (int x = 0; x < columns; x += lanes)
      for (int i = 0; i < count;) {
        V seen = V{} + T(1) / directions, change = {};  // of seen
        for (bool last = false; !last; ++i) {
          const SkySample<T>& a = samples[i];
          last = a.last;
          const Sight sight(load(z + x), z + x + a.offset, a);
          const V ds = (load(dz + x + a.offset) - load(dz + x)) * sight.rate;
          T* const mean = out + per_band * a.band * columns + x;
          increase(mean, a.weight * ds);
          increase(mean + columns, a.weight * 2 * sight.sine * ds);
          if constexpr (sided) {
            increase(mean + 2 * columns, a.weight * a.east * ds);
            increase(mean + 3 * columns, a.weight * a.north * ds);
          }
          change = sight.left(change) - 2 * hidden_sky * positive(sight.sine) * ds * seen;
          seen = sight.left(seen);
        }
        increase(open + x, change);
        if constexpr (sided) {
          increase(open + columns + x, samples[i - 1].east * change);
          increase(open + 2 * columns + x, samples[i - 1].north * change);
        }
      }
  }

  HWY_INLINE static T root(T x) {
    if constexpr (sizeof(T) == sizeof(float)) return __builtin_sqrtf(x);
    else return __builtin_sqrt(x);
  }

  /// sums[o] = start + sum over i of matrix[o * row + i * column] * in[i], for four outputs at a
  /// time, which share the loaded values.
  HWY_INLINE static void multiply(const T* matrix, std::ptrdiff_t row, std::ptrdiff_t column,
                                  const T* start, int inputs, int outputs, const T* in, T* out) {
    int o = 0;
    for (; o + 4 <= outputs; o += 4) {
      V sum[4][2];
      for (int j = 0; j < 4; ++j) sum[j][0] = sum[j][1] = V{} + (start ? start[o + j] : T(0));
      for (int i = 0; i < inputs; ++i) {
        const V a = load(in + i * columns), b = load(in + i * columns + lanes);
        for (int j = 0; j < 4; ++j) {
          const T w = matrix[(o + j) * row + i * column];
          sum[j][0] += a * w;
          sum[j][1] += b * w;
        }
      }
      for (int j = 0; j < 4; ++j) {
        store(out + (o + j) * columns, sum[j][0]);
        store(out + (o + j) * columns + lanes, sum[j][1]);
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
        for (int i = 0; i < n; i += lanes) {
          const V v = load(values + i), r = inverse_root(1 + v * v);
          store(values + i, v * r);
          store(slopes + i, r * r * r);
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
