// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweeps.h"

#include <vector>

#include "sweep.h"

namespace surf::limits {

std::span<const Sweep> sweeps() {
  static const std::vector<Sweep> all{
      bank_cutoff(),
      energy_range(),
      off_pixel_size(),
      off_training_sizes(),
      off_training_slopes(),
      one_sided_detector(),
      tip_threshold(),
      tip_two_peaks(),
      training_pixels(),
      trench_width(),
      wrong_energy(),
  };
  return all;
}

}  // namespace surf::limits
