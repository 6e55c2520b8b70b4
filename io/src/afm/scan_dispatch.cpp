// SPDX-License-Identifier: GPL-3.0-or-later
#include "scan_dispatch.h"

#include <array>
#include <fstream>

#include "../lower_extension.h"
#include "scan_formats.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"

namespace surf::io {
namespace {

struct Format {
  bool (*is)(std::string_view content);
  Scan (*parse)(const std::string& file, std::string_view content);
};

// By content. The order matters only where one's mark could begin another's file.
constexpr std::array formats{
    Format{is_gsf, parse_gsf},
};

bool is_text_name(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  for (const char* known : {".txt", ".xyz", ".asc", ".csv", ".dat", ".tsv"})
    if (extension == known) return true;
  return false;
}

[[noreturn]] void fail_unknown(const std::string& file) {
  throw FileError(file, "neither its content nor its name is that of a scan format known here",
                  "Install Gwyddion (apt-get install gwyddion), through which semsurf reads 139 formats "
                  "more, or export the scan as .gwy, .gsf or text");
}

}  // namespace

ScanFile open_scan(const std::filesystem::path& path) {
  const std::string file = path.string();
  ScanFile opened{std::make_unique<const std::string>(read_file(path)), {}};
  const std::string& content = *opened.content;
  if (content.empty()) throw FileError(file, "the file is empty", "Copy or export it again");
  for (const Format& format : formats) {
    if (!format.is(content)) continue;
    opened.scan = format.parse(file, content);
    return opened;
  }
  if (is_image_file(path)) {
    opened.content.reset();
    opened.scan = parse_image_scan(path);
  } else if (is_text_name(path)) {
    opened.scan = parse_text_scan(file, content);
  } else {
    fail_unknown(file);
  }
  return opened;
}

bool is_scan_file(const std::filesystem::path& path) {
  if (is_text_name(path)) return true;
  constexpr std::size_t enough = 1 << 16;
  std::ifstream stream(path, std::ios::binary);
  std::string start(enough, '\0');
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(stream.gcount()));
  for (const Format& format : formats)
    if (format.is(start)) return true;
  return false;
}

}  // namespace surf::io
