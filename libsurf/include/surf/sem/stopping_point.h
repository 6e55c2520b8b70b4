// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "surf/sem/image_model.h"

namespace surf {

/// How the number I of stopping points above the surface determines a channel.
enum class StoppingRule {
  reflected,  ///< I = eta / (1 + eta): for backscattered electrons (Aristov 1991; thesis, 2.2.3)
  counted,    ///< the signal is I: for secondaries; an extension of ours
};

/// The places where electrons of one kind stop that enter an endless medium at the origin,
/// downward.
struct StoppingPointChannel {
  std::string name;
  StoppingRule rule = StoppingRule::counted;
  /// Stopping points per primary and nm of height, in rings about the beam: ring k extends from k
  /// ring_nm to (k + 1) ring_nm. Row-major: one row per ring with `heights` numbers, at lowest_nm,
  /// lowest_nm + height_step_nm ...; linear in between. All >= 0; the first and the last number of
  /// each ring are 0.
  std::vector<double> density_per_nm;
};

struct StoppingPointParameters {
  double ring_nm = 1;         ///< > 0
  double lowest_nm = 0;       ///< of the first number, relative to the place where the beam enters
  double height_step_nm = 1;  ///< > 0
  int rings = 0;              ///< 1 to 4096
  int heights = 0;            ///< 2 to 4096
  std::vector<StoppingPointChannel> channels;  ///< 1 to 8
};

/// A channel is a function of I, the number of stopping points above the surface: the sum over all
/// surrounding pixels of the stopping points in the pixel's column above its height. The surface is
/// treated as level within a pixel. With `reflected` the signal is I / (1 - I) up to I = 1/2, where
/// a surface would return everything that it receives. Beyond I = 1/2 the signal is the tangent, 4
/// I - 1, so that it stays finite at thin spikes, but it is meaningless there.
///
/// The model neglects electrons that leave the surface and enter it again. It counts electrons that
/// stop beyond the surface even if they could not have come there through matter. The scope needs a
/// pixel size, and the rings may extend over at most `most_stopping_columns` pixels. Throws
/// InvalidInput for parameters out of range.
std::shared_ptr<const ImageModel> make_stopping_point(const ModelScope& scope,
                                                      const StoppingPointParameters& parameters);

inline constexpr int most_stopping_columns = 100;

}  // namespace surf
