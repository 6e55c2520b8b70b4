// SPDX-License-Identifier: GPL-3.0-or-later
// Bruker (Digital Instruments, Veeco) Nanoscope, from version 4.2: lines "\key: value" in sections
// "\*Ciao image list", ended by 0x1A; the samples of each image at its "Data offset", the lowest
// row first. Height = sample / 2^(8 "Bytes/pixel") * "Z scale" (V) * the sensitivity that it names
// (nm/V).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bytes.h"
#include "samples.h"
#include "scan_formats.h"
#include "surf/core/error.h"

namespace surf::io {
namespace {

using Section = std::map<std::string, std::string>;  // keys in small letters: versions differ

struct Header {
  std::vector<Section> images;
  Section all;  ///< of the sections before the images; the first of a key
};

/// Some files have no first backslash, or begin with "?" for it.
bool has_magic(std::string_view content) {
  return content.starts_with("\\*File list") || content.starts_with("?*File list") ||
         content.starts_with("\\*Force file list");
}

Header parse_header(std::string_view text) {
  Header header;
  Section* current = &header.all;
  for_each_text_line(text, [&](std::string_view line) {
    if (line.empty()) return;
    line.remove_prefix(1);
    if (line.starts_with('*')) {
      const std::string name = lower_case(trimmed(line.substr(1)));
      if (name == "ciao image list") current = &header.images.emplace_back();
      else if (name == "file list end") return;
      else current = &header.all;
      return;
    }
    // "@2:Z scale: V [...] ..." has its group before the key.
    std::string_view key_part = line;
    if (line.starts_with('@')) {
      key_part.remove_prefix(1);
      const std::size_t colon = key_part.find(':');
      if (colon == 1 && key_part[0] >= '0' && key_part[0] <= '9') key_part.remove_prefix(2);
    }
    const std::size_t colon = key_part.find(':');
    if (colon == std::string_view::npos) return;
    current->emplace(fmt::format("{}{}", line.starts_with('@') ? "@" : "",
                                 lower_case(trimmed(key_part.substr(0, colon)))),
                     trimmed(key_part.substr(colon + 1)));
  });
  return header;
}

std::string text_of(const Section& section, const std::string& key) {
  const auto found = section.find(key);
  return found == section.end() ? std::string{} : found->second;
}

double number_of(const Bytes& bytes, const Section& image, const Section& all,
                 const std::string& key) {
  std::string text = text_of(image, key);
  if (text.empty()) text = text_of(all, key);
  const auto value = scan_number(text);
  if (!value) bytes.fail(fmt::format("an image's '{}' is '{:.40}'", key, text));
  return *value;
}

/// "V [Sens. Zsens] (0.005 V/LSB) 2.9 V": the text in brackets, and the number and unit at the end.
struct Scale {
  std::string sensitivity;
  double value = 0;
  std::string unit;
};

Scale parse_scale(const Bytes& bytes, const std::string& text) {
  Scale scale;
  std::string_view rest = text;
  const std::size_t open = rest.find('['), close = rest.find(']');
  if (open != std::string_view::npos && close != std::string_view::npos && open < close)
    scale.sensitivity = lower_case(rest.substr(open + 1, close - open - 1));
  if (const std::size_t bracket = rest.rfind(')'); bracket != std::string_view::npos)
    rest.remove_prefix(bracket + 1);
  else if (close != std::string_view::npos) rest.remove_prefix(close + 1);
  else if (rest.starts_with("V ")) rest.remove_prefix(2);
  std::string_view unit;
  const auto value = leading_number(rest, unit);
  if (!value) bytes.fail(fmt::format("an image's Z scale is '{:.60}'", text));
  scale.value = *value;
  scale.unit = clean_text(unit);
  return scale;
}

/// Turns a scale in V into what the sensitivity "V 20.8 nm/V" says.
void apply_sensitivity(const Section& all, Scale& scale) {
  const std::string text = text_of(all, "@" + scale.sensitivity);
  if (scale.sensitivity.empty() || !text.starts_with("V ")) return;
  std::string_view unit;
  const auto factor = leading_number(std::string_view(text).substr(2), unit);
  const std::size_t slash = unit.rfind('/');
  if (!factor || slash == std::string_view::npos || slash == 0) return;
  const std::string per = clean_text(unit.substr(slash + 1));
  if (per != scale.unit) return;
  scale.value *= *factor;
  scale.unit = clean_text(unit.substr(0, slash));
}

/// The name in quotes is for people, that in brackets what other readers show.
std::string name_of(const Section& image) {
  const std::string text = text_of(image, "@image data");
  const std::size_t open = text.find('['), close = text.find(']');
  if (open != std::string::npos && close != std::string::npos && open < close)
    return clean_text(std::string_view(text).substr(open + 1, close - open - 1));
  return clean_text(text);
}

/// Widths and heights in nm: "500 500 nm", "15 15 ~m"; one number is the width.
std::array<double, 2> size_nm(const Bytes& bytes, const Section& image, const Section& all) {
  std::string text = text_of(image, "scan size");
  if (text.empty()) text = text_of(all, "scan size");
  std::string_view rest, unit;
  const auto x = leading_number(text, rest);
  if (!x) bytes.fail(fmt::format("an image's scan size is '{:.40}'", text));
  const auto y = leading_number(rest, unit);
  const auto nm = scan_length_nm(y ? unit : rest);
  if (!nm || !(*x > 0) || !(y.value_or(1) > 0))
    bytes.fail(fmt::format("an image's scan size is '{:.40}'", text));
  return {*x * *nm, y ? *y * *nm : 0};
}

ScanChannel image_channel(const Bytes& bytes, const Header& header, const Section& image) {
  const auto number = [&](const char* key) { return number_of(bytes, image, header.all, key); };
  const double offset = number("data offset"), length = number("data length");
  const double width = number("samps/line"), height = number("number of lines");
  check_scan_size(bytes.file(), width, height, 1, bytes.size());
  const bool inside = offset >= 0 && length >= 0 && offset <= double(bytes.size());
  if (!inside)
    bytes.fail(
        fmt::format("an image begins at byte {:.0f}, and the file has {}", offset, bytes.size()));
  // From version 9.2 on 4 bytes may be stored where "Bytes/pixel" says 2, which still tells the
  // scale.
  const double stated = number("bytes/pixel");
  if (stated != 2 && stated != 4)
    bytes.fail(fmt::format("an image has {:g} bytes per pixel", stated));
  const double each = length / (width * height);
  if (each != 2 && each != 4)
    bytes.fail(
        fmt::format("an image of {:.0f} x {:.0f} samples has {:.0f} bytes", width, height, length));
  const Bytes data = bytes.part(static_cast<std::size_t>(offset), static_cast<std::size_t>(length));
  const std::string scale_text = text_of(image, "@z scale");
  if (scale_text.empty() || !image.contains("@image data"))
    throw Unsupported(bytes.file(), "Nanoscope files older than version 4.2 are not read here",
                      "Install Gwyddion, through which semsurf reads them");
  Scale scale = parse_scale(bytes, scale_text);
  apply_sensitivity(header.all, scale);
  ScanChannel channel;
  channel.name = name_of(image);
  channel.z_unit = scale.unit;
  channel.width = static_cast<int>(width);
  channel.height = static_cast<int>(height);
  const auto size = size_nm(bytes, image, header.all);
  channel.pitch_x_nm = size[0] / width;
  channel.pitch_y_nm = size[1] > 0 ? size[1] / height : channel.pitch_x_nm;
  for (const char* key : {"line direction", "frame direction"})
    if (const std::string text = text_of(image, key); !text.empty())
      channel.metadata[key] = clean_text(text);
  const SampleLayout layout{.type = each == 2 ? SampleType::int16 : SampleType::int32,
                            .scale = scale.value / std::exp2(8 * stated)};
  channel.values = [data, w = channel.width, h = channel.height, layout] {
    return read_samples(data, w, h, layout);
  };
  return channel;
}

}  // namespace

bool is_nanoscope(std::string_view content) { return has_magic(content); }

Scan parse_nanoscope(const std::string& file, std::string_view content) {
  const Bytes bytes(file, content);
  const std::size_t end = std::min(content.find("\x1A"), content.size());
  const Header header = parse_header(content.substr(0, end));
  Scan scan{"Bruker Nanoscope", {}, {}, {}};
  for (const auto& [key, value] : header.all)
    if (!key.starts_with('@') && !value.empty()) scan.metadata[clean_text(key)] = clean_text(value);
  for (const Section& image : header.images)
    scan.channels.push_back(image_channel(bytes, header, image));
  return scan;
}

}  // namespace surf::io
