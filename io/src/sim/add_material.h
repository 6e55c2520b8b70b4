// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/io/sim/scene_file.h"

namespace surf::io {

/// Returns the index of a material among the specimen's materials. Adds the material if it is
/// missing. Throws UsageError naming `subject` for an unknown material.
int add_material(SceneFile& scene, const std::string& name, const std::string& subject);

}  // namespace surf::io
