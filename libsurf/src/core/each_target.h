// SPDX-License-Identifier: GPL-3.0-or-later
// Loops that are compiled for each instruction set, by Highway. A source with such loops begins
//
//     #undef HWY_TARGET_INCLUDE
//     #define HWY_TARGET_INCLUDE "afm/explained.cpp"   // the source itself
//     #include "core/each_target.h"
//
// and is read once for each: for SSE4, AVX2 and AVX-512, for NEON, and for processors without.
// Namespace HWY_NAMESPACE between HWY_BEFORE_NAMESPACE() and HWY_AFTER_NAMESPACE() is compiled for
// the one at hand, the rest of the source stands in #if HWY_ONCE. There HWY_EXPORT(f) and
// HWY_DYNAMIC_DISPATCH(f)(arguments) call the best f that the processor has. Arithmetic is in plain
// loops or in the compiler's vectors of SEMSURF_VECTOR_BYTES, whose operators read as formulas.
// Read anew for each instruction set: no include guard.
#ifndef HWY_DISABLED_TARGETS
// Vectors without a size cannot be members; SSSE3 alone is of processors before 2008.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#endif

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#undef SEMSURF_VECTOR_BYTES
#define SEMSURF_VECTOR_BYTES (HWY_MAX_BYTES < 16 ? 16 : HWY_MAX_BYTES)
