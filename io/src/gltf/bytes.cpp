// SPDX-License-Identifier: GPL-3.0-or-later
#include "bytes.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "surf/core/error.h"

namespace surf::io {
namespace {

std::string little_endian(std::uint64_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<char>(value >> (8 * i) & 0xff));
  return bytes;
}

void pad(std::string& content, char filler) {
  content.resize((content.size() + 3) / 4 * 4, filler);
}

}  // namespace

template <class T>
GltfBytes::Stretch GltfBytes::add_numbers(std::span<const T> values) {
  const std::string_view raw(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  const Stretch stretch = add(raw);
  if constexpr (std::endian::native == std::endian::big) {
    for (std::size_t i = 0; i < stretch.bytes; i += sizeof(T)) {
      const auto first = content_.begin() + static_cast<std::ptrdiff_t>(stretch.offset + i);
      std::reverse(first, first + sizeof(T));
    }
  }
  return stretch;
}

GltfBytes::Stretch GltfBytes::add(std::span<const float> values) { return add_numbers(values); }
GltfBytes::Stretch GltfBytes::add(std::span<const std::uint32_t> values) {
  return add_numbers(values);
}
GltfBytes::Stretch GltfBytes::add(std::span<const std::uint16_t> values) {
  return add_numbers(values);
}

GltfBytes::Stretch GltfBytes::add(std::string_view bytes) {
  const Stretch stretch{content_.size(), bytes.size()};
  content_.append(bytes);
  pad(content_, '\0');
  return stretch;
}

std::string format_glb(const std::string& file, std::string json, std::string binary) {
  pad(json, ' ');
  pad(binary, '\0');
  const std::size_t chunks = binary.empty() ? 1 : 2;
  const std::uint64_t total = 12 + 8 * chunks + json.size() + binary.size();
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    throw InvalidInput(file, "it would have more than the 4 GB that GLB can count",
                       "Write .gltf, whose data lie in a file beside it, or simplify the surface");
  }
  std::string head =
      "glTF" + little_endian(2) + little_endian(total) + little_endian(json.size()) + "JSON" + json;
  if (!binary.empty()) head += little_endian(binary.size()) + std::string("BIN\0", 4);
  binary.insert(0, head);  // in place where there is room: the binary part can be large
  return binary;
}

}  // namespace surf::io
