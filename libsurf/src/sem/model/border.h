// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/edge.h"

namespace surf {

/// The index of the sample that continues a line of `count` (at least 2) samples at index `i`, as
/// `edge` says. Reflections and periods are repeated as often as necessary.
inline int border_sample(int i, int count, Edge edge) {
  if (i >= 0 && i < count) return i;
  if (edge == Edge::flat) return i < 0 ? 0 : count - 1;
  const int period = edge == Edge::periodic ? count : 2 * (count - 1);
  i %= period;
  if (i < 0) i += period;
  return i < count ? i : period - i;
}

}  // namespace surf
