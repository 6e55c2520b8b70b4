// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/instruction_set.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/instruction_set.cpp"
#include "core/each_target.h"

HWY_BEFORE_NAMESPACE();
namespace surf::HWY_NAMESPACE {

const char* name() {
#if HWY_TARGET == HWY_AVX3
  return "x86-64 with AVX-512";
#elif HWY_TARGET == HWY_AVX2
  return "x86-64 with AVX2";
#elif HWY_ARCH_X86
  return "x86-64";
#elif HWY_ARCH_ARM_A64
  return "AArch64";
#else
  return "unknown";
#endif
}

}  // namespace surf::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace surf {

HWY_EXPORT(name);
std::string_view instruction_set() { return HWY_DYNAMIC_DISPATCH(name)(); }

}  // namespace surf
#endif
