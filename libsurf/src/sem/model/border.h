// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

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

/// Adds `unit` times some values, the first of which belongs to index `first`, to the samples of a
/// line that continue it there.
template <class T>
void add_continued(const T* values, int count, int first, double unit, Edge edge, double* line,
                   int samples) {
  int i = 0;
  for (; i < count && first + i < 0; ++i)
    line[border_sample(first + i, samples, edge)] += unit * values[i];
  for (const int end = std::min(count, samples - first); i < end; ++i)
    line[first + i] += unit * values[i];
  for (; i < count; ++i) line[border_sample(first + i, samples, edge)] += unit * values[i];
}

}  // namespace surf
