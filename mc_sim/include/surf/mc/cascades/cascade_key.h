// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "surf/mc/physics/physics.h"

namespace surf::mc {

struct CascadeSettings;

/// Everything that page `number` of a library depends on, the format's version among it, as lines
/// of text.
std::string cascade_page_key(const CascadeSettings& settings, std::size_t number);

/// What such a key says, as far as people want to know it.
struct CascadePageName {
  std::string library;  ///< the same for all pages of a library, and for no other's
  std::size_t number = 0;
  std::size_t cascades = 0;  ///< in the page
  bool is_current = false;   ///< whether this version of semsurf could use the page
  std::string material;
  Physics physics;               ///< with the cutoff that holds
  bool is_usual_cutoff = false;  ///< whether it is the one that holds where none is asked for
  double beam_energy_ev = 0;  ///< of primaries in vacuum that are inside where the library starts
  std::uint64_t seed = 0;
};

/// Reads a key; nothing where it is no page of cascades.
std::optional<CascadePageName> read_cascade_page_key(const std::string& key);

}  // namespace surf::mc
