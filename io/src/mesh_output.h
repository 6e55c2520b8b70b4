// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/mesh/triangle_mesh.h"

namespace surf::io {

// One function per format, behind write_mesh: the content of the file. `mesh` is valid and in file
// units, `file` is the name for messages.

std::string format_stl(const std::string& file, const TriangleMesh& mesh);
std::string format_obj(const TriangleMesh& mesh);
std::string format_ply(const std::string& file, const TriangleMesh& mesh);
std::string format_off(const TriangleMesh& mesh);

}  // namespace surf::io
