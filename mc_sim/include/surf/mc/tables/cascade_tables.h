// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mc/cascades/cascade_library.h"
#include "surf/sem/diffusion_matrix.h"
#include "surf/sem/stopping_point.h"

namespace surf::mc {

struct CascadeTableOptions {
  int rings = 48;  ///< of the table, around the beam, out to the farthest stopping point, 1 to 1024
  int heights = 96;  ///< of the table, from the lowest to the highest stopping point, 2 to 1024
  /// If above 0, the SE channel of stopping points is scaled so that level ground gives this yield.
  /// If 0, the channel counts all secondaries that stop above the surface, also those that started
  /// there. That is ten to a hundred times the number that leaves a real surface.
  /// `diffusion_matrix` does not use it.
  double flat_se_yield = 0;
};

/// Where the electrons of all cascades of a library stop: the channels BSE, of primaries (rule
/// `reflected`), and SE, of all others (rule `counted`), per primary. 0 is where the primaries
/// start. Throws InvalidInput for an empty library, UsageError for options out of range.
StoppingPointParameters stopping_points(const CascadeLibrary& library,
                                        const CascadeTableOptions& options = {});

/// The flux of electrons around where primaries start, over all cascades of a library: the channels
/// BSE, of electrons that would have 50 eV or more in vacuum, and SE, of the others, each weighed
/// by its probability to get over the barrier out of a direction of Lambert's law. The first piece
/// of each primary, which goes straight down from the entry and can leave through no height field,
/// is left out. Throws as `stopping_points`.
DiffusionMatrixParameters diffusion_matrix(const CascadeLibrary& library,
                                           const CascadeTableOptions& options = {});

}  // namespace surf::mc
