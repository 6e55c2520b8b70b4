// SPDX-License-Identifier: GPL-3.0-or-later
#include "network_units.h"

#include "network_loops.h"

// One body for each vector unit, chosen when the program runs.
namespace surf::network {
namespace {

#define SEMSURF_LOOPS(name, bytes, target)                                                        \
  template <class T>                                                                              \
  struct name {                                                                                   \
    using L = Loops<T, bytes>;                                                                    \
    using Samples = const SkySample<T>*;                                                          \
    using Layers = const Layer<T>*;                                                               \
    target static void facets(const T* k, int rows, T length, T* out, std::ptrdiff_t stride) {    \
      L::facets(k, rows, length, out, stride);                                                    \
    }                                                                                             \
    target static void facets_back(const T* k, int rows, T length, const T* weight,               \
                                   std::ptrdiff_t stride, T* out) {                               \
      L::facets_back(k, rows, length, weight, stride, out);                                       \
    }                                                                                             \
    target static void facets_change(const T* k, const T* dk, int rows, T length, T* out,         \
                                     std::ptrdiff_t stride) {                                     \
      L::facets_change(k, dk, rows, length, out, stride);                                         \
    }                                                                                             \
    target static void sky(const T* z, Samples samples, int count, int bands, T* out) {           \
      L::sky(z, samples, count, bands, out);                                                      \
    }                                                                                             \
    target static void sky_back(const T* z, Samples samples, int count, int bands,                \
                                const T* weight, T* dz, const std::ptrdiff_t* to, T* work) {      \
      L::sky_back(z, samples, count, bands, weight, dz, to, work);                                \
    }                                                                                             \
    target static void sky_change(const T* z, const T* dz, Samples samples, int count, int bands, \
                                  T* out) {                                                       \
      L::sky_change(z, dz, samples, count, bands, out);                                           \
    }                                                                                             \
    target static void forward(Layers layers, int count, const T* in, T* values, T* slopes) {     \
      L::forward(layers, count, in, values, slopes);                                              \
    }                                                                                             \
    target static void backward(Layers layers, int count, const T* slopes, const T* weight,       \
                                T* work, T* out) {                                                \
      L::backward(layers, count, slopes, weight, work, out);                                      \
    }                                                                                             \
    target static void change(Layers layers, int count, const T* slopes, const T* in, T* work,    \
                              T* out) {                                                           \
      L::change(layers, count, slopes, in, work, out);                                            \
    }                                                                                             \
    static constexpr Operations<T> all{                                                           \
        L::columns, facets,     facets_back, facets_change, sky,                                  \
        sky_back,   sky_change, forward,     backward,      change};                              \
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

}  // namespace

template <class T>
const Operations<T>& operations(Unit unit) {
#ifdef __x86_64__
  switch (facet::resolve(unit)) {
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

}  // namespace surf::network
