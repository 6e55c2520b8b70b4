// SPDX-License-Identifier: GPL-3.0-or-later
// Compiles loops for several instruction sets, with Highway. A source file with such loops begins
//
//     #undef HWY_TARGET_INCLUDE
//     #define HWY_TARGET_INCLUDE "afm/explained.cpp"   // the source itself
//     #include "core/each_target.h"
//
// and is compiled once for each target: SSE4, AVX2, AVX-512, NEON, and processors without any of
// them. The code between HWY_BEFORE_NAMESPACE() and HWY_AFTER_NAMESPACE() is in namespace
// HWY_NAMESPACE and is compiled for the current target. The rest of the source stands in #if
// HWY_ONCE; there HWY_EXPORT(f) and HWY_DYNAMIC_DISPATCH(f)(arguments) call the best f that the
// processor supports. Arithmetic is written as plain loops or with the compiler's vectors of
// SEMSURF_VECTOR_BYTES, whose operators read like formulas; with Highway's own operations where
// the loop asks whether any number of a vector passes a test. This header has no include guard,
// because it is included again for each target.
#include "core/left_out_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#undef SEMSURF_VECTOR_BYTES
#define SEMSURF_VECTOR_BYTES (HWY_MAX_BYTES < 16 ? 16 : HWY_MAX_BYTES)
