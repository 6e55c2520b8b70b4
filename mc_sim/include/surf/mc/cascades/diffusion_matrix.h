// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mc/cascades/stopping_points.h"
#include "surf/sem/diffusion_matrix.h"

namespace surf::mc {

/// The flux of electrons around where primaries start, over all cascades of a library: the channels
/// BSE, of electrons that would have 50 eV or more in vacuum, and SE, of the others, each weighed
/// by its probability to get over the barrier out of a direction of Lambert's law. The first piece
/// of each primary, which goes straight down from the entry and can leave through no height field,
/// is left out. Throws as `stopping_points`.
DiffusionMatrixParameters diffusion_matrix(const CascadeLibrary& library,
                                           const CascadeTableOptions& options = {});

}  // namespace surf::mc
