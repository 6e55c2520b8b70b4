// SPDX-License-Identifier: GPL-3.0-or-later
// The instruction sets, of those that Highway knows, that loops are not compiled for. To be
// included before any of Highway's headers, which decide by it what they call generated.
#pragma once

// Sizeless vectors cannot be members of structs. SSSE3 without SSE4 is found only in processors
// from before 2008.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
