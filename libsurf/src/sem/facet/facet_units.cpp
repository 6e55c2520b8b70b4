// SPDX-License-Identifier: GPL-3.0-or-later
#include "facet_units.h"

#include "facet_loops.h"

// One body for each vector unit, chosen when the program runs.
namespace surf::facet {
namespace {

#define SEMSURF_LOOPS(name, bytes, target)                                                         \
  template <class T>                                                                               \
  struct name {                                                                                    \
    using L = Loops<T, bytes>;                                                                     \
    target static void across(const T* z, std::ptrdiff_t stride, int rows, const Tap<T>* taps,     \
                              int radius, T* out) {                                                \
      L::across(z, stride, rows, taps, radius, out);                                               \
    }                                                                                              \
    target static void along(const T* moment, int rows, const Tap<T>* taps, int radius,            \
                             const Scaling<T>& scaling, T* out) {                                  \
      L::along(moment, rows, taps, radius, scaling, out);                                          \
    }                                                                                              \
    target static void along_transposed(const T* weight, int rows, const Tap<T>* taps, int begin,  \
                                        int radius, bool add, T* const* out,                       \
                                        std::ptrdiff_t plane) {                                    \
      L::along_transposed(weight, rows, taps, begin, radius, add, out, plane);                     \
    }                                                                                              \
    target static void turn(const T* plane, std::ptrdiff_t stride, int count,                      \
                            std::ptrdiff_t out_stride, T* out) {                                   \
      L::turn(plane, stride, count, out_stride, out);                                              \
    }                                                                                              \
    target static void across_transposed(const T* moment, int count, const Tap<T>* taps,           \
                                         int radius, T* sum) {                                     \
      L::across_transposed(moment, count, taps, radius, sum);                                      \
    }                                                                                              \
    target static void invariants(const T* k, int rows, T* out) { L::invariants(k, rows, out); }   \
    target static void combine(const T* k, int rows, const Weights<T>* weights, int channels,      \
                               T* sum) {                                                           \
      L::combine(k, rows, weights, channels, sum);                                                 \
    }                                                                                              \
    target static void pull_back(const T* k, int rows, const Floors<T>& floors,                    \
                                 const Weights<T>* weights, int channels, const T* weight,         \
                                 T* out) {                                                         \
      L::pull_back(k, rows, floors, weights, channels, weight, out);                               \
    }                                                                                              \
    target static void push_forward(const T* k, const T* dk, int rows, const Floors<T>& floors,    \
                                    const Weights<T>* weights, int channels, T* sum) {             \
      L::push_forward(k, dk, rows, floors, weights, channels, sum);                                \
    }                                                                                              \
    target static void angles(const T* k, int rows, double* tangent, double* secant,               \
                              double* angle) {                                                     \
      L::angles(k, rows, tangent, secant, angle);                                                  \
    }                                                                                              \
    target static void spread(const T* samples, int count, const T* worth, T* out) {               \
      L::spread(samples, count, worth, out);                                                       \
    }                                                                                              \
    target static void spread_transposed(const T* weight, int count, const T* worth, T* samples) { \
      L::spread_transposed(weight, count, worth, samples);                                         \
    }                                                                                              \
    target static void between_rows(const T* samples, int first, int step, int rows, T* out) {     \
      L::between_rows(samples, first, step, rows, out);                                            \
    }                                                                                              \
    target static void between_rows_transposed(const T* weight, int first, int step, int rows,     \
                                               T* samples) {                                       \
      L::between_rows_transposed(weight, first, step, rows, samples);                              \
    }                                                                                              \
    target static T largest(const T* values, std::ptrdiff_t count) {                               \
      return L::largest(values, count);                                                            \
    }                                                                                              \
    target static void relative(const double* z, int count, double level, T* out) {                \
      L::relative(z, count, level, out);                                                           \
    }                                                                                              \
    static constexpr Operations<T> all{L::columns,        across,       along,                     \
                                       along_transposed,  turn,         across_transposed,         \
                                       invariants,        combine,      pull_back,                 \
                                       push_forward,      angles,       spread,                    \
                                       spread_transposed, between_rows, between_rows_transposed,   \
                                       relative,          largest};                                \
  };

SEMSURF_LOOPS(Portable, 16, )
#ifdef __x86_64__
SEMSURF_LOOPS(Avx2, 32, [[gnu::target("avx2,fma")]])
#ifdef __clang__  // which knows no preference here
SEMSURF_LOOPS(Avx512, 64, [[gnu::target("avx512f,avx512bw,avx512vl,avx512dq,fma")]])
#else
SEMSURF_LOOPS(Avx512, 64,
              [[gnu::target("avx512f,avx512bw,avx512vl,avx512dq,fma,prefer-vector-width=512")]])
#endif
#endif

bool is_available(Unit unit) {
#ifdef __x86_64__
  if (unit == Unit::avx512)
    return __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq");
  if (unit == Unit::avx2) return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#endif
  return unit == Unit::portable;
}

}  // namespace

Unit resolve(Unit unit) {
  if (unit != Unit::best) return is_available(unit) ? unit : Unit::portable;
  return is_available(Unit::avx512) ? Unit::avx512
         : is_available(Unit::avx2) ? Unit::avx2
                                    : Unit::portable;
}

template <class T>
const Operations<T>& operations(Unit unit) {
#ifdef __x86_64__
  switch (resolve(unit)) {
    case Unit::avx512:
      return Avx512<T>::all;
    case Unit::avx2:
      return Avx2<T>::all;
    default:
      break;
  }
#endif
  (void)unit;
  return Portable<T>::all;
}

template const Operations<float>& operations<float>(Unit);
template const Operations<double>& operations<double>(Unit);

}  // namespace surf::facet
