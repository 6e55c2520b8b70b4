// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "drawn_scene.h"

namespace surf::bench {

/// A number of a surface, and its derivatives by the heights.
struct Scalar {
  double value = 0;
  Grid<double> by_height;
};

/// The mean height of the inner quarter of the plateau.
Scalar plateau_height(const HeightField& surface, const Block& plateau);

/// The distance of the line's walls at half its height, of the mean profile over 200 nm along the
/// line. None if the profile does not cross this height within 80 nm of the true wall.
std::optional<Scalar> line_width(const HeightField& surface, const Block& line);

/// Minus the mean of the first three numbers of a round change of the tip: the logarithm of its
/// apex's radius over the given one, to first order.
double apex_radius(const reconstruction::TipChange& tip);
reconstruction::TipChange apex_radius_by_tip();

/// Linear functions of the unknowns, by their derivatives: the map's parts (the shift is that of
/// the middle of the surface), the common factor of the gains, the offset, and the tip's numbers.
std::vector<reconstruction::Step> few_functions(const reconstruction::Objective& objective,
                                                const reconstruction::Unknowns& at);

}  // namespace surf::bench
