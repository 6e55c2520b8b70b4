// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sweep.h"

namespace surf::limits {

// Each in the file of its name.
Sweep energy_range();

}  // namespace surf::limits
