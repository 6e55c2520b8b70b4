// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "surf/core/track.h"
#include "surf/mesh/surface.h"
#include "surface_note.h"

namespace surf::io {

/// A body of a file, in the file's units and with the file's name, which may be empty.
struct ParsedBody {
  std::string material;  ///< as the file calls it; empty if the file names none
  Surface surface;  ///< scalars have finite values and names in the form that `validate` demands
};

/// The content of a file in its units, which the note states.
struct ParsedFile {
  std::vector<ParsedBody> bodies;
  std::vector<Track> tracks;
  SurfaceNote note;
  bool is_in_nm = false;      ///< the parser converted coordinates itself
  bool unit_assumed = false;  ///< neither the file nor the caller stated a unit: 1 nm is assumed
};

/// The part of a file to read: scalars, pictures and tracks take time and can be damaged.
enum class Want { shapes, everything };

/// Splits a polygon into triangles around its first corner.
inline void add_fan(const std::vector<std::uint32_t>& corners, std::vector<Triangle>& triangles) {
  for (std::size_t i = 2; i < corners.size(); ++i) {
    triangles.push_back({corners[0], corners[i - 1], corners[i]});
  }
}

/// Splits a strip into triangles. Every other triangle has the opposite orientation. A corner given
/// twice joins two strips and makes no triangle.
inline void add_strip(const std::vector<std::uint32_t>& corners, std::vector<Triangle>& triangles) {
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const std::size_t odd = i % 2;
    const Triangle t{corners[i - 2], corners[i - 1 + odd], corners[i - odd]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
}

inline constexpr std::uint64_t max_mesh_vertices = std::uint64_t{1} << 32;

}  // namespace surf::io
