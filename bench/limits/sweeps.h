// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sweep.h"

namespace surf::limits {

// Each in the file of its name, or several of a kind in one.
// Each in the file of its name.
Sweep accuracy_memory();
Sweep bank_cutoff();
Sweep calibration_alike();
Sweep choice_of_method();
Sweep coincident_faces();
Sweep deep_trench();
Sweep energy_range();
Sweep far_origin();
Sweep flipped_normals();
Sweep grazing_incidence();
Sweep mesh_holes();
Sweep mesh_tolerance();
Sweep off_pixel_size();
Sweep off_training_sizes();
Sweep off_training_slopes();
Sweep one_sided_detector();
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
Sweep slivers();
Sweep guided_detail();
Sweep guided_sparse();
Sweep thin_features();
Sweep tip_threshold();
Sweep tip_two_peaks();
Sweep training_pixels();
Sweep trench_width();
Sweep wall_angle();
Sweep wrong_energy();

}  // namespace surf::limits
