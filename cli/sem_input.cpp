// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem_input.h"

#include <fmt/format.h>

#include <utility>

#include "terminal.h"

namespace surf::cli {

PlacedImage read_sem_input(const std::string& file, const io::SemReadOptions& options, bool quiet) {
  io::SemFile read = io::read_sem_image(file, options);
  if (!quiet)
    for (const std::string& note : read.notes) print_note(fmt::format("{}: {}", file, note));
  return std::move(read.image);
}

}  // namespace surf::cli
