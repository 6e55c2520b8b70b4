// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace surf::workflow {

/// Images from above tell heights by how dark it is beside walls, in which tiers of physics differ:
/// what they tell is uncertain by this share of the height, beside all else (bench_views, and
/// the depths of bench_profile).
constexpr double shading_doubt = 0.1;

/// The standard error of a number whose fit stated `fitted` from its prior's deviation (0: held,
/// infinite: none) and data, if the data are uncertain by `doubt` beside what the fit knew of.
double doubted_error(double fitted, double prior_deviation, double doubt);

}  // namespace surf::workflow
