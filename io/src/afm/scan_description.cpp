// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/image_formats.h"
#include "scan_formats.h"

namespace surf::io {

Image head_of(const HeightField& field, const std::map<std::string, std::string>& metadata) {
  Image head;
  head.placement() = field.placement();
  head.metadata = metadata;
  return head;
}

std::string description_of(const HeightField& field,
                           const std::map<std::string, std::string>& metadata) {
  std::string text;
  for_each_text_line(to_description(head_of(field, metadata)), [&](std::string_view line) {
    if (!line.starts_with("image:channels=")) text.append(line).append("\n");
  });
  return text;
}

bool apply_description(std::string_view lines, const std::string& file, Scan& scan) {
  const Attributes attributes = parse_description(lines);
  const bool ours =
      attributes.contains("image:pitch_x_nm") && attributes.contains("image:pitch_y_nm");
  if (!ours) return false;
  Image head;
  apply_attributes(attributes, file, head);
  for (ScanChannel& channel : scan.channels) {
    channel.pitch_x_nm = head.pitch_x_nm;
    channel.pitch_y_nm = head.pitch_y_nm;
    channel.pitch_guessed = false;
  }
  scan.origin_x_nm = head.origin_x_nm;
  scan.origin_y_nm = head.origin_y_nm;
  scan.metadata = head.metadata;
  return true;
}

}  // namespace surf::io
