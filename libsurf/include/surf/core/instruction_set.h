// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace surf {

/// The instruction set that this process uses for vectorised loops: "x86-64 with AVX-512", "x86-64
/// with AVX2", "x86-64", "AArch64". Results on different instruction sets differ by rounding.
std::string_view instruction_set();

}  // namespace surf
