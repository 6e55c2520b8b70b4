// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/left_out_targets.h"

#include <hwy/targets.h>

#include <cstdint>
#include <string>
#include <vector>

namespace surf::test {

/// The instruction sets that this machine has and loops are compiled for, the best first, and that
/// of processors without (libsurf/src/core/each_target.h).
inline std::vector<std::int64_t> vector_targets() { return hwy::SupportedAndGeneratedTargets(); }

inline std::string name_of_target(std::int64_t target) { return hwy::TargetName(target); }

/// While one lives, loops are those of that instruction set.
class OnlyTarget {
 public:
  explicit OnlyTarget(std::int64_t target) { choose(target); }
  ~OnlyTarget() { choose(0); }
  OnlyTarget(const OnlyTarget&) = delete;
  OnlyTarget& operator=(const OnlyTarget&) = delete;

 private:
  static void choose(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

}  // namespace surf::test
