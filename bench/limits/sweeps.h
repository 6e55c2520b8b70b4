// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sweep.h"

namespace surf::limits {

// Each in the file of its name.
Sweep bank_cutoff();
Sweep energy_range();
Sweep off_pixel_size();
Sweep off_training_sizes();
Sweep off_training_slopes();
Sweep one_sided_detector();
Sweep tip_threshold();
Sweep tip_two_peaks();
Sweep training_pixels();
Sweep trench_width();
Sweep wrong_energy();

}  // namespace surf::limits
