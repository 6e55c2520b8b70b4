// SPDX-License-Identifier: GPL-3.0-or-later
// Nanosurf .nid: sections "[DataSet-0:1]" of lines "key=value" in Latin-1, "#!", then the channels
// one after the other in the order that "[DataSet]" lists them, the lowest row first.
#include <fmt/format.h>

#include <cmath>

#include "bytes.h"
#include "samples.h"
#include "scan_formats.h"

namespace surf::io {
namespace {

using Section = std::map<std::string, std::string, std::less<>>;
using Sections = std::map<std::string, Section, std::less<>>;

Sections parse_sections(std::string_view text) {
  Sections sections;
  Section* current = nullptr;
  for_each_text_line(text, [&](std::string_view line) {
    line = trimmed(line);
    if (line.starts_with('[') && line.ends_with(']')) {
      current = &sections[std::string(line.substr(1, line.size() - 2))];
      return;
    }
    const std::size_t equals = line.find('=');
    if (!current || equals == std::string_view::npos) return;
    current->emplace(trimmed(line.substr(0, equals)), trimmed(line.substr(equals + 1)));
  });
  return sections;
}

std::string text_of(const Section& section, std::string_view key) {
  const auto found = section.find(key);
  return found == section.end() ? std::string{} : found->second;
}

double number_of(const Bytes& bytes, const Section& section, std::string_view key) {
  const auto value = scan_number(text_of(section, key));
  if (!value || !std::isfinite(*value))
    bytes.fail(fmt::format("its header does not say {} of a channel", key));
  return *value;
}

struct Stored {
  SampleType type;
  std::endian order;
  double full, lowest;  ///< how many values there are, and the least
};

Stored stored(const Bytes& bytes, const Section& section) {
  const double bits = number_of(bytes, section, "SaveBits");
  const bool is_signed = text_of(section, "SaveSign") != "Unsigned";
  const std::endian order =
      text_of(section, "SaveOrder") == "Motorola" ? std::endian::big : std::endian::little;
  if (text_of(section, "SaveMode") != "Binary" || (bits != 8 && bits != 16 && bits != 32))
    bytes.fail(fmt::format("its numbers of {:g} bits, {}, cannot be read here", bits,
                           text_of(section, "SaveMode")),
               "Export it as .gwy, .gsf or text");
  const SampleType type = bits == 8    ? is_signed ? SampleType::int8 : SampleType::uint8
                          : bits == 16 ? is_signed ? SampleType::int16 : SampleType::uint16
                          : is_signed  ? SampleType::int32
                                       : SampleType::uint32;
  const double full = std::exp2(bits);
  return {type, order, full, is_signed ? -0.5 * full : 0};
}

/// "Z-Axis forward" for "Z-Axis" of the frame "Scan forward".
std::string name_of(const Section& section) {
  std::string frame = text_of(section, "Frame");
  if (frame.starts_with("Scan ")) frame.erase(0, 5);
  return clean_text(text_of(section, "Dim2Name") + (frame.empty() ? "" : " " + frame));
}

double pitch_nm(const Bytes& bytes, const Section& section, const std::string& axis, double count,
                bool& guessed) {
  const auto unit_nm = scan_length_nm(text_of(section, axis + "Unit"));
  guessed = guessed || !unit_nm;
  return std::abs(number_of(bytes, section, axis + "Range")) / count * unit_nm.value_or(1);
}

}  // namespace

bool is_nid(std::string_view content) {
  return content.starts_with("[DataSet]") &&
         content.substr(0, 4096).find("GroupCount=") != std::string_view::npos;
}

Scan parse_nid(const std::string& file, std::string_view content) {
  const Bytes bytes(file, content);
  const std::size_t end = content.find("#!");
  if (end == std::string_view::npos) bytes.fail("its header does not end");
  const Sections sections = parse_sections(content.substr(0, end));
  Scan scan{"Nanosurf", {}, {}, {}};
  if (const auto info = sections.find("DataSet-Info"); info != sections.end())
    for (const auto& [key, value] : info->second)
      if (!value.empty()) scan.metadata[clean_text(key)] = clean_text(value);
  constexpr double most = 1000;
  const auto found = sections.find("DataSet");
  if (found == sections.end()) bytes.fail("its header has no list of channels");
  const Section& list = found->second;
  const double groups = number_of(bytes, list, "GroupCount");
  std::size_t at = end + 2;
  for (int group = 0; group < std::min(groups, most); ++group) {
    const auto count = scan_number(text_of(list, fmt::format("Gr{}-Count", group))).value_or(0);
    for (int i = 0; i < std::min(count, most); ++i) {
      const auto section = sections.find(text_of(list, fmt::format("Gr{}-Ch{}", group, i)));
      if (section == sections.end()) continue;
      const Section& s = section->second;
      const double width = number_of(bytes, s, "Points"), height = number_of(bytes, s, "Lines");
      const Stored form = stored(bytes, s);
      check_scan_size(file, width, height, bytes_of(form.type), content.size());
      const Bytes data =
          bytes.part(at, static_cast<std::size_t>(width * height) * bytes_of(form.type));
      at += data.size();
      if (!scan_length_nm(text_of(s, "Dim1Unit"))) continue;  // curves, not an image
      const double scale = number_of(bytes, s, "Dim2Range") / form.full;
      ScanChannel channel;
      channel.name = name_of(s);
      channel.z_unit = clean_text(text_of(s, "Dim2Unit"));
      channel.width = static_cast<int>(width);
      channel.height = static_cast<int>(height);
      channel.pitch_x_nm = pitch_nm(bytes, s, "Dim0", width, channel.pitch_guessed);
      channel.pitch_y_nm = pitch_nm(bytes, s, "Dim1", height, channel.pitch_guessed);
      const SampleLayout layout{.type = form.type,
                                .order = form.order,
                                .scale = scale,
                                .offset = number_of(bytes, s, "Dim2Min") - form.lowest * scale};
      channel.values = [data, w = channel.width, h = channel.height, layout] {
        return read_samples(data, w, h, layout);
      };
      scan.channels.push_back(std::move(channel));
    }
  }
  return scan;
}

}  // namespace surf::io
