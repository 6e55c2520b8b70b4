// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "replay/replay_site.h"
#include "sampling/stratified_permutation.h"

namespace surf::mc {

/// Takes the pixels of a tile through the library together, block by block of cascades: what one
/// pixel replays is still near when the next one comes. A `Pixel` has a `site`, a `subset`, and
/// `used` and `end`, the first of its primaries to be served and one past the last. Calls serve(i,
/// electron, cascade) for each primary, with `replay` at the site of pixel i.
template <class Pixel, class Serve>
void by_blocks(const std::vector<Pixel>& pixels, std::size_t cascades, SiteReplay& replay,
               const Serve& serve) {
  for (std::uint64_t block = 0; block < cascades / StratifiedPermutation::block; ++block)
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const Pixel& p = pixels[i];
      bool there = false;
      p.subset.each_of_block(block, p.used, p.end,
                             [&](std::uint64_t electron, std::size_t cascade) {
                               if (!there) replay.go_to(p.site);
                               there = true;
                               // Of a run the next one is the neighbour.
                               if (cascade + 1 < cascades) replay.fetch(p.site, cascade + 1);
                               serve(i, electron, cascade);
                             });
    }
}

}  // namespace surf::mc
