// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "surf/mc/geometry/scene.h"
#include "surf/mc/request/simulation_options.h"

namespace surf::mc {

/// "direct" or "replay".
const char* name(Method method);

/// The method of that name, or none for "auto". Throws UsageError naming `subject` for other words.
std::optional<Method> parse_method(std::string_view text, std::string_view subject);

/// What choosing a method has to respect.
struct MethodLimits {
  bool observed = false;                    ///< observers will watch, as for deposited energy
  double library_bytes = 2.0 * (1u << 30);  ///< memory for all libraries of a scene, above 0
};

struct MethodChoice {
  Method method = Method::direct;
  std::string reason;        ///< goes on after "direct: " or "replay: "; no full stop
  std::size_t cascades = 0;  ///< of each material, for replay, whichever is chosen
  double library_bytes = 0;  ///< about, of all materials together
};

/// How electrons of these options are best simulated; `options.method` does not count. With `asked`
/// it is that, or a UsageError which says why it cannot be. Else replay where it can serve, its
/// libraries fit into memory, and they take less work than they save. Work is counted on a few
/// cascades and primaries, not timed: the choice is the same with any number of threads and any
/// cache. With a wanted accuracy those few primaries also tell how many it takes. Where observers
/// will watch there can be none: a UsageError.
MethodChoice choose_method(const Scene& scene, const SimulationOptions& options,
                           std::optional<Method> asked = {}, const MethodLimits& limits = {});

}  // namespace surf::mc
