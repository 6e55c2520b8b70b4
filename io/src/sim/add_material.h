// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/io/sim/scene_file.h"

namespace surf::io {

/// The place of a material among those of the specimen, where it is added if it is not there.
/// Throws UsageError naming `subject` for one that is not known.
int add_material(SceneFile& scene, const std::string& name, const std::string& subject);

}  // namespace surf::io
