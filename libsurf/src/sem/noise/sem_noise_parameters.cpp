// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/estimate_sem_noise.h"

namespace surf {

void describe(ParameterVisitor& visit, SemNoiseOptions& o) {
  std::optional<int> block = o.block_px != 0 ? std::optional(o.block_px) : std::nullopt;
  visit(block, {.name = "noise.block",
                .help = "Side in pixels of the blocks among which flat ones are looked for",
                .limits = within(6, 64),
                .otherwise = "16, 12 or 8",
                .level = Level::advanced});
  o.block_px = block.value_or(0);
  visit(o.black, {.name = "noise.black",
                  .help = "Pixels at or below this level are saturated",
                  .otherwise = "found",
                  .form = "LEVEL",
                  .level = Level::advanced});
  visit(o.white, {.name = "noise.white",
                  .help = "Pixels at or above this level are saturated",
                  .otherwise = "found",
                  .form = "LEVEL",
                  .level = Level::advanced});
}

}  // namespace surf
