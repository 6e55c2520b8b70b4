// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace surf::io {

/// The growing binary part of a glTF file: little-endian numbers, each array at a multiple of 4.
class GltfBytes {
 public:
  /// The place of an array.
  struct Stretch {
    std::size_t offset = 0;
    std::size_t bytes = 0;
  };

  void reserve(std::size_t bytes) { content_.reserve(bytes); }

  Stretch add(std::span<const float> values);
  Stretch add(std::span<const std::uint32_t> values);
  Stretch add(std::span<const std::uint16_t> values);
  Stretch add(std::string_view bytes);

  std::size_t size() const { return content_.size(); }
  std::string take() { return std::move(content_); }

 private:
  template <class T>
  Stretch add_numbers(std::span<const T> values);

  std::string content_;
};

/// Formats a GLB file (glTF 2.0, 4.4) from text and binary part, which may be empty. Throws
/// InvalidInput beyond the 4 GB that the format can count.
std::string format_glb(const std::string& file, std::string json, std::string binary);

}  // namespace surf::io
