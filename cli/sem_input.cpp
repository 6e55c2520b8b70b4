// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem_input.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "surf/workflow/picture_input.h"
#include "terminal.h"

namespace surf::cli {

PlacedImage read_sem_input(const std::string& file, const io::SemReadOptions& options, bool quiet) {
  io::SemFile read = io::read_sem_image(file, options);
  if (!quiet)
    for (const std::string& note : read.notes) print_note(fmt::format("{}: {}", file, note));
  return std::move(read.image);
}

workflow::SemInput read_sem_channel(const std::string& name, io::SemReadOptions options,
                                    bool quiet) {
  const workflow::FileChannel part = workflow::parse_file_channel(name);
  if (!part.channel.empty()) options.channel = part.channel;
  PlacedImage image = read_sem_input(part.file, options, quiet);
  return {std::move(image), part.file, std::move(options)};
}

mc::Material read_material(const io::MaterialChoice& choice, bool quiet) {
  std::vector<std::string> notes;
  mc::Material material = io::find_material(choice, notes);
  if (!quiet)
    for (const std::string& note : notes) print_note(note);
  return material;
}

}  // namespace surf::cli
