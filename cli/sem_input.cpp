// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem_input.h"

#include <fmt/format.h>

#include <utility>

#include "options.h"
#include "surf/core/error.h"
#include "surf/io/sem_file.h"
#include "terminal.h"

namespace surf::cli {

PlacedImage read_sem_input(const SemInputText& input, bool quiet) {
  io::SemReadOptions options;
  options.channel = input.channel.value_or("");
  if (input.pixel_size) {
    const auto [x, y] = parse_pixel_size(*input.pixel_size, "--sem-pixel-size");
    options.pixel_x_nm = x, options.pixel_y_nm = y;
  }
  io::SemFile file = io::read_sem_image(input.file, options);
  if (!quiet)
    for (const std::string& note : file.notes) print_note(fmt::format("{}: {}", input.file, note));
  return std::move(file.image);
}

}  // namespace surf::cli
