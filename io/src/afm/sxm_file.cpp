// SPDX-License-Identifier: GPL-3.0-or-later
// Nanonis .sxm: lines ":KEY:" with their text below, 0x1A 0x04, then 32-bit floats, a channel after
// the other, each forward and backward. A scan downward stores the top row first; the way back runs
// from right to left. Lines not yet scanned are NaN.
#include <fmt/format.h>

#include "bytes.h"
#include "samples.h"
#include "scan_formats.h"

namespace surf::io {
namespace {

constexpr std::string_view header_end = "\x1A\x04";

std::map<std::string, std::string, std::less<>> parse_header(std::string_view text) {
  std::map<std::string, std::string, std::less<>> keys;
  std::string* current = nullptr;
  for_each_text_line(text, [&](std::string_view line) {
    if (line.size() > 2 && line.starts_with(':') && line.ends_with(':')) {
      current = &keys[std::string(line.substr(1, line.size() - 2))];
    } else if (current) {
      current->append(line).append("\n");
    }
  });
  return keys;
}

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words;
  constexpr std::string_view blanks = " \t\r\n";
  for (std::size_t at = line.find_first_not_of(blanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(blanks, at), line.size());
    words.emplace_back(line.substr(at, end - at));
    at = line.find_first_not_of(blanks, end);
  }
  return words;
}

}  // namespace

bool is_sxm(std::string_view content) { return content.starts_with(":NANONIS_VERSION:"); }

Scan parse_sxm(const std::string& file, std::string_view content) {
  const Bytes bytes(file, content);
  const std::size_t end = content.find(header_end);
  if (end == std::string_view::npos) bytes.fail("its header does not end");
  const auto header = parse_header(content.substr(0, end));
  const auto text = [&](std::string_view key) {
    const auto found = header.find(key);
    return found == header.end() ? std::string{} : found->second;
  };
  const auto two_numbers = [&](std::string_view key) {
    const auto words = words_of(text(key));
    const auto x = words.size() > 1 ? scan_number(words[0]) : std::nullopt;
    const auto y = words.size() > 1 ? scan_number(words[1]) : std::nullopt;
    if (!x || !y || !(*x > 0) || !(*y > 0))
      bytes.fail(fmt::format("its header does not say {}", key));
    return std::pair{*x, *y};
  };
  // No structured bindings: Clang 14 cannot take them into lambdas.
  const auto pixels = two_numbers("SCAN_PIXELS"), size = two_numbers("SCAN_RANGE");
  const double width = pixels.first, height = pixels.second, size_x = size.first,
               size_y = size.second;
  check_scan_size(file, width, height, sizeof(float), content.size());
  const auto type = words_of(text("SCANIT_TYPE"));
  if (type.empty() || type[0] != "FLOAT")
    bytes.fail("its numbers are not of type FLOAT", "Export it as .gsf or text");
  const auto order =
      type.size() > 1 && type[1] == "LSBFIRST" ? std::endian::little : std::endian::big;
  const bool down = trimmed(text("SCAN_DIR")) == "down";
  Scan scan{"Nanonis", {}, {}, {}};
  for (const auto& [key, value] : header)
    if (key != "DATA_INFO" && key != "SCANIT_END" && !trimmed(value).empty())
      scan.metadata[key] = clean_text(value);
  const std::size_t image_bytes = sizeof(float) * static_cast<std::size_t>(width * height);
  std::size_t at = end + header_end.size();
  for_each_text_line(text("DATA_INFO"), [&](std::string_view line) {
    const auto words = words_of(line);
    if (words.size() < 4 || words[0] == "Channel") return;
    const bool both = words[3] == "both";
    for (const bool backward : {false, true}) {
      if (backward ? words[3] != "backward" && !both : words[3] == "backward") continue;
      ScanChannel channel;
      channel.name =
          clean_text(fmt::format("{} ({})", words[1], backward ? "Backward" : "Forward"));
      channel.z_unit = clean_text(words[2]);
      channel.width = static_cast<int>(width);
      channel.height = static_cast<int>(height);
      channel.pitch_x_nm = size_x / width * 1e9;  // m
      channel.pitch_y_nm = size_y / height * 1e9;
      const SampleLayout layout{.type = SampleType::float32,
                                .order = order,
                                .top_row_first = down,
                                .right_column_first = backward};
      channel.values = [data = bytes.part(at, image_bytes), w = channel.width, h = channel.height,
                        layout] { return read_samples(data, w, h, layout); };
      at += image_bytes;
      scan.channels.push_back(std::move(channel));
    }
  });
  return scan;
}

}  // namespace surf::io
