// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "scene_view.h"

namespace surf::io {

/// The content of a 3MF file.
std::string write_3mf(const std::string& file, const SceneView& scene);

}  // namespace surf::io
