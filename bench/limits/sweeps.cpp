// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweeps.h"

#include <vector>

#include "sweep.h"

namespace surf::limits {

std::span<const Sweep> sweeps() {
  static const std::vector<Sweep> all{
      accuracy_memory(),
      bank_cutoff(),
      calibration_alike(),
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
      reconstruction_drift(),
      reconstruction_first_scale(),
      reconstruction_gains(),
      reconstruction_last_scale(),
      reconstruction_map(),
      reconstruction_material(),
      reconstruction_sem_noise(),
      reconstruction_untouched(),
      registration_landmarks(),
      registration_lattice(),
      registration_overlap(),
      registration_repeats(),
      registration_start(),
      registration_turn(),
      slivers(),
      thin_features(),
      guided_detail(),
      guided_sparse(),
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
