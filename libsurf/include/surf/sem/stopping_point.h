// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "surf/sem/image_model.h"

namespace surf {

/// How what stops above the surface gives a channel.
enum class StoppingRule {
  reflected,  ///< I = eta / (1 + eta): backscattered electrons (Aristov 1991; thesis, 2.2.3)
  counted,    ///< I itself: secondaries. An extension of ours
};

/// Where electrons of one kind stop that enter an endless medium at the origin, downward.
struct StoppingPointChannel {
  std::string name;
  StoppingRule rule = StoppingRule::counted;
  /// Stopping points per primary and nm of height, in rings about the beam: ring k reaches from k
  /// ring_nm to (k + 1) ring_nm. Row-major, rings rows of `heights` numbers at lowest_nm, lowest_nm
  /// + height_step_nm
  /// ...; between them linear. All >= 0; the first and the last of each ring are 0.
  std::vector<double> density_per_nm;
};

struct StoppingPointParameters {
  double ring_nm = 1;         ///< > 0
  double lowest_nm = 0;       ///< height of the first number, relative to where the beam enters
  double height_step_nm = 1;  ///< > 0
  int rings = 0;              ///< 1 to 4096
  int heights = 0;            ///< 2 to 4096
  std::vector<StoppingPointChannel> channels;  ///< 1 to 8
};

/// A channel is a function of I, the number of stopping points above the surface: the sum over all
/// pixels around of those in the pixel's column above its height, which is taken as level in
/// itself. With `reflected` the signal is I / (1 - I) up to I = 1/2, where a surface would give
/// back all it gets, and goes on by its tangent, 4 I - 1, so that thin spikes stay finite; there it
/// means nothing.
///
/// It knows of no electron that leaves and enters again, and counts those that are past the surface
/// though in matter they could not have come there. The scope needs a pixel size, and the rings may
/// reach `most_stopping_columns` of its pixels at most. Throws InvalidInput for parameters out of
/// range.
std::shared_ptr<const ImageModel> make_stopping_point(const ModelScope& scope,
                                                      const StoppingPointParameters& parameters);

inline constexpr int most_stopping_columns = 100;

}  // namespace surf
