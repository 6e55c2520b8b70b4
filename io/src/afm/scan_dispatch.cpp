// SPDX-License-Identifier: GPL-3.0-or-later
#include "scan_dispatch.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <system_error>
#include <utility>

#include "files/lower_extension.h"
#include "gwyddion_program.h"
#include "scan_formats.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "tiff_tags.h"

namespace surf::io {
namespace {

struct Format {
  bool (*is)(std::string_view content);
  Scan (*parse)(const std::string& file, std::string_view content);
};

// By content. The order matters only where one's mark could begin another's file.
constexpr std::array formats{
    Format{is_gwy, parse_gwy},
    Format{is_gsf, parse_gsf},
    Format{is_nanoscope, parse_nanoscope},
    Format{is_nid, parse_nid},
    Format{is_sxm, parse_sxm},
    Format{is_wsxm, parse_wsxm},
    Format{is_park_tiff, parse_park},
    Format{is_jpk, parse_jpk},
    Format{is_ibw, parse_ibw},
};

bool is_text_name(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  for (const char* known : {".txt", ".xyz", ".asc", ".csv", ".dat", ".tsv"})
    if (extension == known) return true;
  return false;
}

[[noreturn]] void fail_unknown(const std::string& file) {
  throw UnknownScan(
      file, "its content is not that of a scan that semsurf reads by itself",
      "Install Gwyddion (apt-get install gwyddion), through which semsurf reads 139 formats "
      "more, or export the scan as .gwy, .gsf or text");
}

/// False where Gwyddion is not installed.
bool open_by_gwyddion(const std::filesystem::path& path, ScanFile& opened) {
  auto converted = convert_by_gwyddion(path);
  if (!converted) return false;
  opened.content = std::make_unique<const std::string>(std::move(*converted));
  opened.scan = parse_gwy(path.string(), *opened.content);
  opened.scan.format = "read by Gwyddion";
  return true;
}

}  // namespace

ScanFile open_scan(const std::filesystem::path& path) {
  const std::string file = path.string();
  ScanFile opened{std::make_unique<const std::string>(read_file(path)), {}};
  const std::string& content = *opened.content;
  if (content.empty()) throw FileError(file, "the file is empty", "Copy or export it again");
  for (const Format& format : formats) {
    if (!format.is(content)) continue;
    try {
      opened.scan = format.parse(file, content);
      return opened;
    } catch (const Unsupported&) {
      if (!open_by_gwyddion(path, opened)) throw;
      return opened;
    }
  }
  if (is_image_file(path)) {
    opened.content.reset();
    opened.scan = parse_image_scan(path);
  } else if (is_text_name(path)) {
    opened.scan = parse_text_scan(file, content);
  } else if (!open_by_gwyddion(path, opened)) {
    fail_unknown(file);
  }
  return opened;
}

bool has_scan_name(const std::filesystem::path& path) {
  // As the instruments' programs name them; .raw, .dat, .data, .img, .top and the like are
  // everybody's.
  static constexpr std::array names{
      ".gwy",         ".gsf",    ".spm",      ".afm", ".ibw",  ".ardf",         ".nid",
      ".nhf",         ".ezd",    ".sxm",      ".stp", ".wsxm", ".mdt",          ".mi",
      ".asd",         ".aris",   ".sdf",      ".x3p", ".jpk",  ".jpk-qi-image", ".jpk-force",
      ".jpk-qi-data", ".h5-jpk", ".hdf5-jpk", ".opd", ".opdx", ".plux",         ".bcrf"};
  const std::string extension = lower_extension(path);
  return std::find(names.begin(), names.end(), extension) != names.end();
}

bool is_scan_file(const std::filesystem::path& path) {
  if (is_text_name(path)) return true;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  constexpr std::size_t enough = 4096;
  std::ifstream stream(path, std::ios::binary);
  std::string start(enough, '\0');
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(stream.gcount()));
  // A TIFF file's marks may lie anywhere.
  if (is_tiff(start)) start = read_file(path);
  return std::any_of(formats.begin(), formats.end(),
                     [&](const Format& format) { return format.is(start); });
}

}  // namespace surf::io
