// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweeps.h"

#include <vector>

#include "sweep.h"

namespace surf::limits {

std::span<const Sweep> sweeps() {
  static const std::vector<Sweep> all{
      calibration_alike(),
      energy_range(),
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
  };
  return all;
}

}  // namespace surf::limits
