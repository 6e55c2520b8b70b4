// SPDX-License-Identifier: GPL-3.0-or-later
#include "max_plus_kernel.h"

// One body for each vector unit, chosen when the program runs.
namespace surf::max_plus {
namespace {

#define SEMSURF_STRIPS(name, bytes, target)                                                  \
  target void plain_##name(const Kernel& b, const Padded& a, int y, int, int height,         \
                           const Strip& out, std::int32_t*) {                                \
    strip<bytes>(b, a, y, height, out);                                                      \
  }                                                                                          \
  target void contact_##name(const Kernel& b, const Padded& a, int y, int width, int height, \
                             const Strip& out, std::int32_t* column_rank) {                  \
    strip_with_contact<bytes>(b, a, y, width, height, out, column_rank);                     \
  }

SEMSURF_STRIPS(portable, 16, )
#ifdef __x86_64__
SEMSURF_STRIPS(avx2, 32, [[gnu::target("avx2")]])
#ifdef __clang__  // which knows no preference here
SEMSURF_STRIPS(avx512, 64, [[gnu::target("avx512f,avx512bw,avx512vl")]])
#else
SEMSURF_STRIPS(avx512, 64, [[gnu::target("avx512f,avx512bw,avx512vl,prefer-vector-width=512")]])
#endif
#endif

}  // namespace

StripFunction strip_function(Unit unit, bool with_contact) {
#ifdef __x86_64__
  if (unit == Unit::avx512) return with_contact ? contact_avx512 : plain_avx512;
  if (unit == Unit::avx2) return with_contact ? contact_avx2 : plain_avx2;
#endif
  (void)unit;
  return with_contact ? contact_portable : plain_portable;
}

int lanes(Unit unit) { return unit == Unit::avx512 ? 16 : unit == Unit::avx2 ? 8 : 4; }

bool is_available(Unit unit) {
#ifdef __x86_64__
  if (unit == Unit::avx512)
    return __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
  if (unit == Unit::avx2) return __builtin_cpu_supports("avx2");
  return true;
#else
  return unit == Unit::portable || unit == Unit::best;
#endif
}

Unit resolve(Unit unit) {
  if (unit != Unit::best) return is_available(unit) ? unit : Unit::portable;
  return is_available(Unit::avx512) ? Unit::avx512
         : is_available(Unit::avx2) ? Unit::avx2
                                    : Unit::portable;
}

}  // namespace surf::max_plus
