// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/tracks_file.h"

#include <fmt/format.h>

#include "files/lower_extension.h"
#include "raster/image_formats.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "vtp_format.h"

namespace surf::io {
namespace {

void check_name(const std::filesystem::path& path) {
  if (lower_extension(path) != ".vtp") {
    throw UsageError(path.string(),
                     fmt::format("tracks are not written as '{}'", path.extension().string()),
                     "Use .vtp, which ParaView opens");
  }
  require_vtk(path.string());
}

}  // namespace

void write_tracks(const std::filesystem::path& path, std::span<const Track> tracks,
                  const std::map<std::string, std::string>& metadata) {
  check_name(path);
  const std::string file = path.string();
  for (const Track& track : tracks) validate(track, file.c_str());
  write_text(path, format_tracks(file, tracks, metadata));
}

std::vector<Track> read_tracks(const std::filesystem::path& path) {
  return parse_tracks(path.string(), read_file(path));
}

void check_tracks_target(const std::filesystem::path& path) {
  check_name(path);
  check_writable(path);
}

}  // namespace surf::io
