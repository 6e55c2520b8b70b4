// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "surface_note.h"

namespace surf::io {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t bytes_of(PlyType type);
inline bool is_whole(PlyType type) { return type < PlyType::float32; }

struct PlyProperty {
  std::string name;
  PlyType type;                       ///< of the value, or of a list's items
  std::optional<PlyType> count_type;  ///< only for lists
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// Index of a property, or -1.
  int find(std::string_view property) const;
};

enum class PlyEncoding { text, little_endian, big_endian };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::text;
  std::vector<PlyElement> elements;
  SurfaceNote note;      ///< from the comments
  std::size_t body = 0;  ///< offset of the first byte after the header
};

/// Parses a PLY header. Throws FileError with the line. Refuses counts that cannot fit into the
/// file.
PlyHeader parse_ply_header(const std::string& file, std::string_view content);

}  // namespace surf::io
