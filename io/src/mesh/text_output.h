// SPDX-License-Identifier: GPL-3.0-or-later
// Functions shared by the writers of text formats.
#pragma once

#include <string>

#include "scene_view.h"

namespace surf::io {

std::size_t count_vertices(const SceneView& scene);
std::size_t count_triangles(const SceneView& scene);

/// Appends "PREFIX x y z", each number with as many digits as reading the same double takes.
void add_vertex_line(std::string& text, const Vec3& v, const char* prefix);

/// One comment line for each entry of the note.
std::string comments(const SurfaceNote& note, bool magnified, const char* prefix);

/// Throws InvalidInput: there are `count` elements, more than the format's indices can number.
[[noreturn]] void refuse_size(const std::string& file, const char* what, std::size_t count);

}  // namespace surf::io
