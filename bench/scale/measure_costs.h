// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>

#include "limits/sweep.h"

namespace surf::scale {

/// Side of the image whose making is foretold, in pixels.
inline constexpr int side = 16384;

/// Columns of the table of costs: what is simulated, then seconds of one processor and bytes for a
/// unit of work, and quantiles of its duration ("q0_s" shortest to "q10_s" longest).
inline constexpr int quantiles = 10;

/// Processor time of units of work of the mesa, and of packing, unpacking, merging and keeping
/// their tallies, by electrons per pixel, method (0 direct, 1 replay) and primaries per unit:
/// direct simulation with larger units than it takes, too. In every line the costs of the whole
/// job: of a scene, a library and a pixel of an image. Scratch files go to `folder`.
limits::Table measure_costs(const std::filesystem::path& folder, bool quick);

}  // namespace surf::scale
