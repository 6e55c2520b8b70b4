// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem_input.h"

#include <fmt/format.h>

#include <tuple>

#include "options.h"
#include "picture_input.h"
#include "surf/core/error.h"

namespace surf::cli {

PlacedImage read_sem_input(const SemInputText& input, bool quiet) {
  (void)quiet;
  GivenPitch pitch;
  if (input.pixel_size) std::tie(pitch.x_nm, pitch.y_nm) = parse_pixel_size(*input.pixel_size, "--sem-pixel-size");
  FileChannel file = parse_file_channel(input.file);
  if (input.channel) file.channel = *input.channel;
  const io::WebImage picture = read_picture(file, pitch);
  if (!picture.has_scale)
    throw InvalidInput(input.file, "it does not say how large its pixels are", "Give their size with --sem-pixel-size");
  const Image& image = picture.image;
  const Channel* channel = file.channel.empty() ? &image.channels.front() : image.find(file.channel);
  if (!channel) channel = &image.channels.front();   // by number
  PlacedImage placed;
  placed.values = Grid<double>(image.width(), image.height());
  for (std::size_t i = 0; i < placed.values.size(); ++i) placed.values.data()[i] = double{channel->values.data()[i]};
  placed.pitch_x_nm = image.pitch_x_nm, placed.pitch_y_nm = image.pitch_y_nm;
  placed.origin_x_nm = image.origin_x_nm, placed.origin_y_nm = image.origin_y_nm;
  if (const Channel* valid = image.find("valid")) {
    placed.valid = Grid<unsigned char>(image.width(), image.height());
    for (std::size_t i = 0; i < placed.valid.size(); ++i) placed.valid.data()[i] = valid->values.data()[i] != 0;
  }
  return placed;
}

}  // namespace surf::cli
