// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "image_formats.h"
#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf::io {
namespace {

constexpr std::string_view metadata_prefix = "semsurf:";
constexpr const char* channels_key = "image:channels";

struct PlacementField {
  const char* key;
  double Image::*value;
  bool is_pitch;
};
constexpr PlacementField placement[] = {
    {"image:pitch_x_nm", &Image::pitch_x_nm, true},
    {"image:pitch_y_nm", &Image::pitch_y_nm, true},
    {"image:origin_x_nm", &Image::origin_x_nm, false},
    {"image:origin_y_nm", &Image::origin_y_nm, false},
};

std::string escape(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '\\':
        escaped += "\\\\";
        break;
      case '\n':
        escaped += "\\n";
        break;
      case '\r':
        escaped += "\\r";
        break;
      case '=':
        escaped += "\\e";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string unescape(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\' || i + 1 == text.size()) {
      plain += text[i];
      continue;
    }
    switch (text[++i]) {
      case 'n':
        plain += '\n';
        break;
      case 'r':
        plain += '\r';
        break;
      case 'e':
        plain += '=';
        break;
      default:
        plain += text[i];
    }
  }
  return plain;
}

/// Calls `use(line)` for every line that is not empty.
template <class Use>
void for_each_line(std::string_view text, const Use& use) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (end > 0) use(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

double parse_placement(const PlacementField& field, const std::string& text,
                       const std::string& file) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end || !std::isfinite(value) ||
      (field.is_pitch && !(value > 0))) {
    throw FileError(file, std::string("its ") + field.key + " is '" + text.substr(0, 40) + "'",
                    "Write the file again with semsurf");
  }
  return value;
}

/// Moves the channels that are named in `list` to the front, in its order, and gives them units.
void apply_channel_list(std::string_view list, Image& image) {
  std::size_t next = 0;
  for_each_line(list, [&](std::string_view line) {
    const std::size_t tab = std::min(line.find('\t'), line.size());
    const std::string_view name = line.substr(0, tab);
    for (std::size_t i = next; i < image.channels.size(); ++i) {
      if (image.channels[i].name != name) continue;
      image.channels[i].unit = line.substr(std::min(tab + 1, line.size()));
      std::swap(image.channels[i], image.channels[next++]);
      break;
    }
  });
}

}  // namespace

Image without_channels(const Image& image) {
  Image copy;
  for (const PlacementField& field : placement) copy.*field.value = image.*field.value;
  copy.metadata = image.metadata;
  return copy;
}

Attributes to_attributes(const Image& image) {
  Attributes attributes;
  for (const PlacementField& field : placement) {
    attributes[field.key] = format_exact(image.*field.value);
  }
  std::string& list = attributes[channels_key];
  for (const Channel& channel : image.channels) {
    list += (list.empty() ? "" : "\n") + channel.name + '\t' + channel.unit;
  }
  for (const auto& [key, value] : image.metadata) {
    if (!value.empty()) attributes[std::string(metadata_prefix) + key] = value;
  }
  return attributes;
}

void apply_attributes(const Attributes& attributes, const std::string& file, Image& image) {
  for (const PlacementField& field : placement) {
    const auto attribute = attributes.find(field.key);
    if (attribute == attributes.end()) continue;
    image.*field.value = parse_placement(field, attribute->second, file);
  }
  if (const auto list = attributes.find(channels_key); list != attributes.end()) {
    apply_channel_list(list->second, image);
  }
  for (const auto& [key, value] : attributes) {
    if (!key.starts_with(metadata_prefix)) continue;
    image.metadata[key.substr(metadata_prefix.size())] = value;
  }
}

std::string to_description(const Image& image) {
  std::string text;
  for (const auto& [key, value] : to_attributes(image)) {
    text += escape(key) + '=' + escape(value) + '\n';
  }
  return text;
}

Attributes parse_description(std::string_view text) {
  Attributes attributes;
  for_each_line(text, [&](std::string_view line) {
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) return;
    attributes[unescape(line.substr(0, equals))] = unescape(line.substr(equals + 1));
  });
  return attributes;
}

}  // namespace surf::io
