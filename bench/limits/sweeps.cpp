// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweeps.h"

#include <vector>

#include "sweep.h"

namespace surf::limits {

std::span<const Sweep> sweeps() {
  static const std::vector<Sweep> all{
      accuracy_memory(),
      choice_of_method(),
      coincident_faces(),
      deep_trench(),
      energy_range(),
      far_origin(),
      flipped_normals(),
      grazing_incidence(),
      mesh_holes(),
      mesh_tolerance(),
      slivers(),
      thin_features(),
      wall_angle(),
  };
  return all;
}

}  // namespace surf::limits
