// SPDX-License-Identifier: GPL-3.0-or-later
// Gwyddion's own files (gwyddion.net/documentation/user-guide-en/gwyfile-format.html): "GWYP" and
// one serialised object, a container of items such as "/0/data", an image. Little-endian; the top
// row first; lengths in the unit that the image names, as a rule m.
#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <utility>

#include "bytes.h"
#include "samples.h"
#include "scan_formats.h"

namespace surf::io {
namespace {

constexpr std::size_t magic_size = 4;

/// A component of an object: its type and the bytes of its value (of arrays: of the items).
struct Item {
  char type = 0;
  Bytes value;
};
using Items = std::vector<std::pair<std::string, Item>>;

struct Object {
  std::string type;
  Bytes content;
};

/// Text up to a NUL; moves `at` behind it.
std::string_view text_at(const Bytes& bytes, std::size_t& at) {
  const std::size_t end = bytes.text().find('\0', std::min(at, bytes.size()));
  if (end == std::string_view::npos) bytes.fail("a text in it does not end");
  const std::string_view text = bytes.text().substr(at, end - at);
  at = end + 1;
  return text;
}

Object object_at(const Bytes& bytes, std::size_t& at) {
  std::string type(text_at(bytes, at));
  const std::size_t size = bytes.little<std::uint32_t>(at);
  at += 4;
  const Bytes content = bytes.part(at, size);
  at += size;
  return {std::move(type), content};
}

std::size_t item_bytes(char type) {
  switch (type) {
    case 'b':
    case 'c':
    case 'C':
      return 1;
    case 'i':
    case 'I':
      return 4;
    case 'q':
    case 'Q':
    case 'd':
    case 'D':
      return 8;
    default:
      return 0;
  }
}

/// Moves `at` over a value of the type, whose bytes are returned.
Bytes value_at(const Bytes& bytes, char type, std::size_t& at) {
  const bool is_array = type >= 'A' && type <= 'Z';
  std::size_t count = 1;
  if (is_array) {
    count = bytes.little<std::uint32_t>(at);
    at += 4;
  }
  const std::size_t first = at;
  if (const std::size_t each = item_bytes(type)) {
    bytes.require(at, count * each);
    at += count * each;
  } else if (type == 's' || type == 'S') {
    for (std::size_t i = 0; i < count; ++i) text_at(bytes, at);
  } else if (type == 'o' || type == 'O') {
    for (std::size_t i = 0; i < count; ++i) object_at(bytes, at);
  } else {
    bytes.fail(fmt::format("it holds a value of the unknown type {:#x}",
                           static_cast<unsigned char>(type)));
  }
  return bytes.part(first, at - first);
}

Items items_of(const Bytes& bytes) {
  Items items;
  for (std::size_t at = 0; at < bytes.size();) {
    std::string name(text_at(bytes, at));
    const char type = static_cast<char>(bytes.little<std::uint8_t>(at++));
    items.emplace_back(std::move(name), Item{type, value_at(bytes, type, at)});
  }
  return items;
}

const Item* find(const Items& items, std::string_view name, char type) {
  for (const auto& [key, item] : items)
    if (key == name && item.type == type) return &item;
  return nullptr;
}

std::string text_of(const Items& items, std::string_view name) {
  const Item* const item = find(items, name, 's');
  return item ? clean_text(item->value.text()) : std::string{};
}

/// The unit in an object GwySIUnit; empty where there is none.
std::string unit_of(const Items& items, std::string_view name) {
  const Item* const item = find(items, name, 'o');
  if (!item) return {};
  std::size_t at = 0;
  return text_of(items_of(object_at(item->value, at).content), "unitstr");
}

double number_of(const Bytes& bytes, const Items& items, std::string_view name) {
  if (const Item* const item = find(items, name, 'd')) return item->value.little<double>(0);
  if (const Item* const item = find(items, name, 'i')) return item->value.little<std::int32_t>(0);
  bytes.fail(fmt::format("an image in it has no {}", name));
}

ScanChannel data_field(const Bytes& bytes) {
  const Items items = items_of(bytes);
  const double width = number_of(bytes, items, "xres"), height = number_of(bytes, items, "yres");
  check_scan_size(bytes.file(), width, height, sizeof(double), bytes.size());
  const Item* const data = find(items, "data", 'D');
  if (!data) bytes.fail("an image in it has no data");
  ScanChannel channel;
  channel.width = static_cast<int>(width);
  channel.height = static_cast<int>(height);
  data->value.require(0, sizeof(double) * static_cast<std::size_t>(width * height));
  channel.z_unit = unit_of(items, "si_unit_z");
  const auto unit_nm = scan_length_nm(unit_of(items, "si_unit_xy"));
  channel.pitch_guessed = !unit_nm;
  channel.pitch_x_nm = number_of(bytes, items, "xreal") / width * unit_nm.value_or(1);
  channel.pitch_y_nm = number_of(bytes, items, "yreal") / height * unit_nm.value_or(1);
  channel.values = [values = data->value, w = channel.width, h = channel.height] {
    return read_samples(values, w, h, {.type = SampleType::float64, .top_row_first = true});
  };
  return channel;
}

/// The number in "/12/data".
std::optional<int> image_number(std::string_view key) {
  int number = 0;
  if (!key.starts_with('/')) return std::nullopt;
  const char* const end = key.data() + key.size();
  const auto [stop, error] = std::from_chars(key.data() + 1, end, number);
  if (error != std::errc{} ||
      std::string_view(stop, static_cast<std::size_t>(end - stop)) != "/data")
    return std::nullopt;
  return number;
}

void add_metadata(const Items& container, int number, ScanChannel& channel) {
  const Item* const meta = find(container, fmt::format("/{}/meta", number), 'o');
  if (!meta) return;
  std::size_t at = 0;
  for (const auto& [key, item] : items_of(object_at(meta->value, at).content))
    if (item.type == 's') channel.metadata[clean_text(key)] = clean_text(item.value.text());
}

}  // namespace

bool is_gwy(std::string_view content) { return content.starts_with("GWYP"); }

Scan parse_gwy(const std::string& file, std::string_view content) {
  const Bytes bytes(file, content);
  std::size_t at = magic_size;
  const Items container = items_of(object_at(bytes, at).content);
  std::map<int, ScanChannel> channels;  // Gwyddion keeps no order in its files
  Scan scan{"Gwyddion", {}, {}, {}};
  for (const auto& [key, item] : container) {
    const auto number = image_number(key);
    if (!number || item.type != 'o') continue;
    std::size_t begin = 0;
    const Object object = object_at(item.value, begin);
    if (object.type != "GwyDataField") continue;
    ScanChannel channel = data_field(object.content);
    channel.name = text_of(container, fmt::format("/{}/data/title", *number));
    add_metadata(container, *number, channel);
    if (find(container, fmt::format("/{}/mask", *number), 'o'))
      scan.notes.push_back(fmt::format(
          "the mask of '{}' is not used: Gwyddion's masks mark, they are no holes", channel.name));
    channels.insert_or_assign(*number, std::move(channel));
  }
  for (auto& [number, channel] : channels) scan.channels.push_back(std::move(channel));
  return scan;
}

}  // namespace surf::io
