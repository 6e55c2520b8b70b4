// SPDX-License-Identifier: GPL-3.0-or-later
#include "known_formats.h"

#include <array>

#include "files/lower_extension.h"

namespace surf::io {
namespace {

// A line for each. Content is asked for in this order: the mark of STL, its length, is the weakest.
constexpr std::array formats{
    &gltf_format,  //
    &three_mf_format, &obj_format, &ply_format, &off_format, &vtp_format, &vtm_format, &stl_format,
};

}  // namespace

std::span<const MeshFormat* const> known_formats() { return formats; }

const MeshFormat* format_of(const std::filesystem::path& path, std::string_view content) {
  for (const MeshFormat* format : formats)
    if (format->is && format->is(content)) return format;
  return format_named(path).format;
}

NamedFormat format_named(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  for (const MeshFormat* format : formats)
    for (const SurfaceFormat& form : format->forms)
      if (form.extension == extension) return {format, &form};
  return {};
}

}  // namespace surf::io
