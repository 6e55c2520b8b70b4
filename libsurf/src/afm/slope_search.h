// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "surf/core/progress.h"

namespace surf {

/// Samples that vote: places in [-1, 1] across the image, heights in nm about a rough fit of a
/// plane.
struct Votes {
  std::vector<float> u, v, z;
  std::size_t size() const { return z.size(); }
};

/// z = offset + a u + b v.
struct SlopedPlane {
  double a = 0, b = 0, offset = 0;  // nm from the centre to the edge
  std::size_t votes = 0;
};

struct SlopeSearch {
  double tolerance = 1;      // nm, half the slab
  double largest_slope = 1;  // nm from the centre to the edge: of |a| and |b|
  double slack = 0;          // share of votes by which a better plane may be missed
  std::size_t limit = 1;     // planes to count at most
  Watch watch;               // for cancellation only
};

/// Finds the plane with most votes within the tolerance. The tolerance is exact to the height of a
/// bin, an eighth of the slab. `known` are initial candidates. Adds the number of counted planes to
/// `evaluated`, and sets `complete` to false at the limit.
SlopedPlane search_slopes(const Votes& votes, const SlopeSearch& search,
                          const std::vector<SlopedPlane>& known, std::size_t& evaluated,
                          bool& complete);

/// The best offset for given slopes, and its votes.
SlopedPlane count_votes(const Votes& votes, double a, double b, double tolerance);

}  // namespace surf
