// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/field_source.h"

#include <fmt/format.h>

#include <utility>

#include "surf/core/error.h"
#include "surf/io/image_file.h"
#include "surf/io/sem_file.h"

namespace surf::io {
namespace {

const Channel& height_channel(const Image& image, const FieldSource& source,
                              const std::string& called, std::vector<std::string>& notes) {
  if (!source.options.channel.empty()) {
    if (const Channel* channel = image.find(source.options.channel)) return *channel;
    throw UsageError("`scan.height_channel`",
                     fmt::format("{} has no channel '{}'", called, source.options.channel),
                     "'semsurf info' lists its channels");
  }
  for (const char* name : {"z_nm", "z"})
    if (const Channel* channel = image.find(name)) return *channel;
  const Channel& first = image.channels.front();
  if (image.channels.size() > 1)
    notes.push_back(
        fmt::format("{}: heights are taken from its first channel, {}", called, first.name));
  return first;
}

HeightField read_scan(const FieldSource& source, const std::string& called,
                      std::vector<std::string>& notes) {
  HeightFieldFile file = read_height_field(source.path, source.options);
  for (const std::string& note : file.notes) notes.push_back(fmt::format("{}: {}", called, note));
  return std::move(file.field);
}

HeightField read_picture(const FieldSource& source, const std::string& called,
                         std::vector<std::string>& notes) {
  if (!source.options.z_unit_nm) refuse_as_heights(source.path);
  const Image image = read_image(source.path);
  return to_height_field(image, height_channel(image, source, called, notes).name,
                         source.options.z_unit_nm.value_or(1));
}

}  // namespace

HeightField read_field(const FieldSource& source, const std::string& called,
                       std::vector<std::string>& notes) {
  HeightField field = is_height_field_file(source.path) ? read_scan(source, called, notes)
                                                        : read_picture(source, called, notes);
  if (!source.options.pitch_x_nm) return field;
  field.pitch_x_nm = *source.options.pitch_x_nm;
  field.pitch_y_nm = source.options.pitch_y_nm.value_or(*source.options.pitch_x_nm);
  field.origin_x_nm = -0.5 * field.pitch_x_nm * (field.z_nm.width() - 1);  // as for shapes
  field.origin_y_nm = -0.5 * field.pitch_y_nm * (field.z_nm.height() - 1);
  return field;
}

}  // namespace surf::io
