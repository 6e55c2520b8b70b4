// SPDX-License-Identifier: GPL-3.0-or-later
// What the writers of text formats share.
#pragma once

#include <string>

#include "scene_view.h"

namespace surf::io {

std::size_t count_vertices(const SceneView& scene);
std::size_t count_triangles(const SceneView& scene);

/// "PREFIX x y z", each number with as many digits as it takes to read the same double.
void add_vertex_line(std::string& text, const Vec3& v, const char* prefix);

/// A line for each entry of the note, as a comment.
std::string comments(const SurfaceNote& note, bool magnified, const char* prefix);

/// Throws InvalidInput: the format's indices end below `count`.
[[noreturn]] void refuse_size(const std::string& file, const char* what, std::size_t count);

}  // namespace surf::io
