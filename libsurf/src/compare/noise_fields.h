// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "surf/compare/noise_correlation.h"
#include "surf/core/grid.h"
#include "surf/core/random.h"

namespace surf {

/// A normal number of variance 1.
double normal(RandomStream& random);

/// Fields of normal numbers of variance 1 with a given correlation, as functions of a seed and a
/// number.
class NoiseFields {
 public:
  NoiseFields(int width, int height, const NoiseCorrelation& correlation);
  ~NoiseFields();

  /// Two independent fields. Thread-safe.
  std::array<Grid<float>, 2> pair(std::uint64_t seed, std::uint64_t number) const;

 private:
  struct Plan;
  int width_, height_;
  std::unique_ptr<Plan> plan_;  // none: independent samples
};

}  // namespace surf
