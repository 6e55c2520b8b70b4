// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace surf {

constexpr std::size_t fewest_rows_with_spectrum = 16;

/// Places of each edge, by row.
using RowPlaces = std::vector<std::vector<double>>;

/// Places of a hole's rim less what its middle is off by, which is no roughness; others as they
/// are.
RowPlaces without_middle(RowPlaces places_nm, bool closed);

struct FollowedRows {
  RowPlaces places_nm;
  double blur_nm2 = 0;  ///< variance of what rows are displaced by beyond that
};

/// Rows follow the roughness as far as it stands out of the noise (Wiener), so that noise does not
/// align itself; what they do not follow blurs. Errors that are not finite: rows that do not show
/// the edge.
FollowedRows follow_rows(const RowPlaces& found_nm, const RowPlaces& errors_nm, bool closed,
                         double distance_nm);

}  // namespace surf
