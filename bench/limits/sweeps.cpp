// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweeps.h"

#include <vector>

#include "sweep.h"

namespace surf::limits {

std::span<const Sweep> sweeps() {
  static const std::vector<Sweep> all{
      accuracy_memory(),
      bank_cutoff(),
      choice_of_method(),
      coincident_faces(),
      deep_trench(),
      energy_range(),
      far_origin(),
      flipped_normals(),
      grazing_incidence(),
      mesh_holes(),
      mesh_tolerance(),
      off_pixel_size(),
      off_training_sizes(),
      off_training_slopes(),
      one_sided_detector(),
      slivers(),
      thin_features(),
      tip_threshold(),
      tip_two_peaks(),
      training_pixels(),
      trench_width(),
      wall_angle(),
      wrong_energy(),
  };
  return all;
}

}  // namespace surf::limits
