// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sweep.h"

namespace surf::limits {

// Each in the file of its name.
Sweep accuracy_memory();
Sweep choice_of_method();
Sweep coincident_faces();
Sweep deep_trench();
Sweep energy_range();
Sweep far_origin();
Sweep flipped_normals();
Sweep grazing_incidence();
Sweep mesh_holes();
Sweep mesh_tolerance();
Sweep slivers();
Sweep thin_features();
Sweep wall_angle();

}  // namespace surf::limits
