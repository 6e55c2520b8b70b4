// SPDX-License-Identifier: GPL-3.0-or-later
// Section numbers are those of the glTF 2.0 specification (Khronos Group, ISO/IEC 12113:2022).
#include "accessors.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

#include "files/base64.h"
#include "files/damaged.h"
#include "files/side_file.h"
#include "files/text_scanner.h"
#include "surf/core/error.h"
#include "surf/io/files.h"

namespace surf::io {
namespace {

namespace fs = std::filesystem;

enum ComponentType : std::uint64_t {
  int8 = 5120,
  uint8 = 5121,
  int16 = 5122,
  uint16 = 5123,
  uint32 = 5125,
  float32 = 5126
};

std::size_t bytes_of(std::uint64_t component, const JsonValue& place) {
  switch (component) {
    case int8:
    case uint8:
      return 1;
    case int16:
    case uint16:
      return 2;
    case uint32:
    case float32:
      return 4;
    default:
      place.fail(fmt::format("{} is not a component type", component));
  }
}

std::size_t components_of(const std::string& type, const JsonValue& place) {
  if (type == "SCALAR") return 1;
  if (type == "VEC3") return 3;
  place.fail(fmt::format("its type is '{}', where positions (VEC3) or indices (SCALAR) belong",
                         shown(type)));
}

template <class T>
double from_bytes(const char* bytes, bool normalized) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    bits |= std::uint64_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
  }
  if constexpr (std::is_same_v<T, float>) {
    return double{std::bit_cast<float>(static_cast<std::uint32_t>(bits))};
  } else {
    const auto value = static_cast<double>(static_cast<T>(bits));
    if (!normalized) return value;
    return std::max(value / static_cast<double>(std::numeric_limits<T>::max()), -1.0);  // 3.11
  }
}

double component(const char* bytes, std::uint64_t type, bool normalized) {
  switch (type) {
    case int8:
      return from_bytes<std::int8_t>(bytes, normalized);
    case uint8:
      return from_bytes<std::uint8_t>(bytes, normalized);
    case int16:
      return from_bytes<std::int16_t>(bytes, normalized);
    case uint16:
      return from_bytes<std::uint16_t>(bytes, normalized);
    case uint32:
      return from_bytes<std::uint32_t>(bytes, false);
    default:
      return from_bytes<float>(bytes, false);
  }
}

/// "a%20b.bin" to "a b.bin".
std::string percent_decoded(const std::string& uri) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
  };
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool is_code =
        uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0;
    text += is_code ? static_cast<char>(16 * digit(uri[i + 1]) + digit(uri[i + 2])) : uri[i];
    if (is_code) i += 2;
  }
  return text;
}

bool has_scheme(const std::string& uri) {
  const auto colon = uri.find(':');
  return colon != std::string::npos && uri.find('/') > colon;
}

}  // namespace

fs::path gltf_buffer_file(const fs::path& path, const JsonValue& buffer, const std::string& uri) {
  if (has_scheme(uri) || uri.starts_with('/') || uri.find('\0') != std::string::npos) {
    buffer.fail(fmt::format("its data is at '{}', not beside the file", shown(uri)),
                "Fetch it, and name it relative to the glTF file; or export GLB");
  }
  const auto file = side_file(path, percent_decoded(uri));
  if (!file) {
    buffer.fail(
        fmt::format("its data at '{}' are not in or below the folder of the file", shown(uri)),
        "Put a copy of them into the folder and name that, or export GLB");
  }
  return *file;
}

struct GltfAccessors::Layout {
  std::uint64_t component = 0;
  std::size_t components = 0;
  std::uint64_t count = 0;
  bool normalized = false;
  std::size_t element_bytes = 0;
};

struct GltfAccessors::View {
  std::string_view bytes;
  std::uint64_t stride = 0;  ///< 0: packed
};

std::string GltfAccessors::load(const JsonValue& buffer, const std::string& uri,
                                std::uint64_t bytes) const {
  if (is_data_uri(uri)) {
    const auto comma = uri.find(',');
    const bool is_base64 = comma != std::string::npos && uri.substr(0, comma).ends_with(";base64");
    const auto decoded =
        is_base64 ? decode_base64(std::string_view(uri).substr(comma + 1)) : std::nullopt;
    if (!decoded) buffer.fail("its data URI is not base64");
    return *decoded;
  }
  const fs::path path = gltf_buffer_file(path_, buffer, uri);
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    buffer.fail(fmt::format("there is no file '{}'", path.string()),
                "Copy it there: a .gltf file needs its .bin files beside it; or export GLB");
  }
  const auto size = fs::file_size(path, error);
  if (!error && size < bytes) {
    buffer.fail(fmt::format("'{}' has {} bytes and should have {}", path.string(), size, bytes),
                "It is cut off or belongs to another file: copy both again");
  }
  return read_file(path);
}

std::string_view GltfAccessors::buffer(std::uint64_t index) {
  const JsonValue buffer = root_.item("buffers", index);
  const std::uint64_t bytes = buffer.require("byteLength").whole();
  const auto uri = buffer.find("uri");
  std::string_view content = binary_;
  if (uri) {
    auto found = loaded_.find(index);
    if (found == loaded_.end()) {
      found = loaded_.emplace(index, load(buffer, uri->text(), bytes)).first;
    }
    content = found->second;
  } else if (index != 0) {
    throw Unsupported(buffer.place(), "it has no data of its own, as in compressed files",
                      "Export without compression");
  }
  if (content.size() < bytes) {
    buffer.fail(fmt::format("{} bytes are announced, and there are {}", bytes, content.size()),
                copy_again);
  }
  return content.substr(0, bytes);
}

/// The rest of the view that `owner` (an accessor or half of a sparse one) names, from its offset.
GltfAccessors::View GltfAccessors::view(const JsonValue& owner) {
  const JsonValue view = root_.item("bufferViews", owner.require("bufferView").whole());
  const std::string_view bytes = buffer(view.require("buffer").whole());
  const std::uint64_t start = view.whole("byteOffset", 0);
  const std::uint64_t size = view.require("byteLength").whole();
  if (start > bytes.size() || size > bytes.size() - start) {
    view.fail(fmt::format("bytes {} to {} lie outside its buffer of {}", start, start + size,
                          bytes.size()));
  }
  const std::uint64_t offset = owner.whole("byteOffset", 0);
  if (offset > size) {
    owner.fail(fmt::format("it begins at byte {} of a view of {} bytes", offset, size));
  }
  return {bytes.substr(start + offset, size - offset), view.whole("byteStride", 0)};
}

GltfAccessors::Layout GltfAccessors::layout(const JsonValue& accessor) const {
  Layout layout;
  const JsonValue type = accessor.require("type");
  layout.component = accessor.require("componentType").whole();
  layout.components = components_of(type.text(), accessor);
  layout.count = accessor.require("count").whole();
  layout.normalized = accessor.boolean("normalized", false);
  layout.element_bytes = layout.components * bytes_of(layout.component, accessor);
  if (layout.count >= std::numeric_limits<std::uint32_t>::max()) {
    accessor.fail(fmt::format("{} values are too many", layout.count), "Simplify the mesh");
  }
  return layout;
}

std::vector<double> GltfAccessors::decode(const JsonValue& owner, const Layout& layout) {
  if (layout.count == 0) return {};
  const View stretch = view(owner);
  const std::uint64_t stride = stretch.stride > 0 ? stretch.stride : layout.element_bytes;
  const std::uint64_t size = stretch.bytes.size();
  if (stride < layout.element_bytes) {
    owner.fail(fmt::format("values of {} bytes lie {} bytes apart", layout.element_bytes, stride));
  }
  // (count - 1) * stride + element_bytes <= size, without overflow.
  if (size < layout.element_bytes || (size - layout.element_bytes) / stride < layout.count - 1) {
    owner.fail(fmt::format("{} values do not fit in the {} bytes of its view", layout.count, size),
               copy_again);
  }
  std::vector<double> values;
  values.reserve(layout.count * layout.components);
  const std::size_t step = layout.element_bytes / layout.components;
  for (std::uint64_t i = 0; i < layout.count; ++i) {
    for (std::size_t c = 0; c < layout.components; ++c) {
      values.push_back(component(stretch.bytes.data() + i * stride + c * step, layout.component,
                                 layout.normalized));
    }
  }
  return values;
}

/// 3.6.2.3: some elements are replaced, named by strictly increasing indices.
void GltfAccessors::apply_sparse(const JsonValue& sparse, const Layout& base,
                                 std::vector<double>& values) {
  const JsonValue places = sparse.require("indices");
  Layout index_layout{.component = places.require("componentType").whole(),
                      .components = 1,
                      .count = sparse.require("count").whole()};
  index_layout.element_bytes = bytes_of(index_layout.component, places);
  if (index_layout.count > base.count) sparse.fail("it replaces more values than there are");
  Layout value_layout = base;
  value_layout.count = index_layout.count;
  const std::vector<double> indices = decode(places, index_layout);
  const std::vector<double> replacements = decode(sparse.require("values"), value_layout);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (!(indices[i] >= 0 && indices[i] < static_cast<double>(base.count))) {
      places.fail(fmt::format("it names value {} of {}", indices[i], base.count));
    }
    const auto target = static_cast<std::size_t>(indices[i]) * base.components;
    for (std::size_t c = 0; c < base.components; ++c) {
      values[target + c] = replacements[i * base.components + c];
    }
  }
}

std::vector<double> GltfAccessors::values(const JsonValue& accessor) {
  const Layout base = layout(accessor);
  const auto sparse = accessor.find("sparse");
  std::vector<double> result;
  if (accessor.find("bufferView")) {
    result = decode(accessor, base);
  } else {
    // Zeros, as many as the file likes; a small file must not fill the memory with them.
    const std::uint64_t most = std::uint64_t{1} << 24;
    if (!sparse || base.count > most) {
      accessor.fail("it has no data", "Export the file again, without compression");
    }
    result.assign(base.count * base.components, 0.0);
  }
  if (sparse) apply_sparse(*sparse, base, result);
  return result;
}

std::vector<Vec3> GltfAccessors::positions(std::uint64_t index) {
  const JsonValue accessor = root_.item("accessors", index);
  if (layout(accessor).components != 3) accessor.fail("positions have three components (VEC3)");
  const std::vector<double> numbers = values(accessor);
  std::vector<Vec3> points(numbers.size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
    if (!is_finite(points[i])) {
      accessor.fail(fmt::format("vertex {} is not finite", i),
                    "Repair the mesh or export it again");
    }
  }
  return points;
}

std::vector<std::uint32_t> GltfAccessors::indices(std::uint64_t index) {
  const JsonValue accessor = root_.item("accessors", index);
  const Layout form = layout(accessor);
  const bool is_unsigned =
      form.component == uint8 || form.component == uint16 || form.component == uint32;
  if (form.components != 1 || !is_unsigned || form.normalized) {
    accessor.fail("indices are unsigned whole numbers (SCALAR)");
  }
  const std::vector<double> numbers = values(accessor);
  return {numbers.begin(), numbers.end()};
}

bool GltfAccessors::is_scalar(std::uint64_t index) const {
  return root_.item("accessors", index).require("type").text() == "SCALAR";
}

std::vector<float> GltfAccessors::scalars(std::uint64_t index) {
  const JsonValue accessor = root_.item("accessors", index);
  if (layout(accessor).components != 1)
    accessor.fail("one number for each vertex (SCALAR) is expected");
  const std::vector<double> numbers = values(accessor);
  std::vector<float> result(numbers.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = static_cast<float>(numbers[i]);
    if (!std::isfinite(result[i])) accessor.fail(fmt::format("value {} is not finite", i));
  }
  return result;
}

std::string GltfAccessors::image(const JsonValue& image) {
  if (image.find("bufferView")) return std::string(view(image).bytes);
  return load(image, image.require("uri").text(), 0);
}

}  // namespace surf::io
