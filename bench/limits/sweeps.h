// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sweep.h"

namespace surf::limits {

// Each in the file of its name, or several of a kind in one.
Sweep calibration_alike();
Sweep energy_range();
Sweep reconstruction_drift();
Sweep reconstruction_first_scale();
Sweep reconstruction_gains();
Sweep reconstruction_last_scale();
Sweep reconstruction_map();
Sweep reconstruction_material();
Sweep reconstruction_sem_noise();
Sweep reconstruction_untouched();
Sweep registration_landmarks();
Sweep registration_lattice();
Sweep registration_overlap();
Sweep registration_repeats();
Sweep registration_start();
Sweep registration_turn();

}  // namespace surf::limits
