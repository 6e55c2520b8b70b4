// SPDX-License-Identifier: GPL-3.0-or-later
#include "afm_options.h"

#include <fmt/format.h>

#include <filesystem>
#include <tuple>

#include "options.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/workflow/version.h"
#include "terminal.h"

namespace surf::cli {

void add_scan_input(CLI::App& app, ScanInput& input) {
  app.add_option("INPUT", input.file, "A scan of any format, or an image of heights")->type_name("FILE");
  app.add_option("--channel", input.channel,
                 "Which of its channels, by name or number; 'semsurf info' lists them (the first of heights)")
      ->type_name("NAME");
  app.add_option("--z-unit", input.z_unit, "Length of one unit of height, of files that do not say (nm)")
      ->type_name("LENGTH");
  app.add_option("--pixel-size", input.pixel_size, "Of files that do not say, 2nm or 2nmx3nm (1 nm)")
      ->type_name("LENGTH");
}

io::HeightFieldFile read_scan(const ScanInput& input, bool quiet) {
  if (input.file.empty()) throw UsageError("INPUT", "no scan is given", "Name a file to read");
  io::HeightReadOptions options;
  options.channel = input.channel.value_or("");
  if (input.z_unit) options.z_unit_nm = parse_unit_nm(*input.z_unit, "--z-unit");
  if (input.pixel_size)
    std::tie(options.pitch_x_nm, options.pitch_y_nm) = parse_pixel_size(*input.pixel_size, "--pixel-size");
  io::HeightFieldFile scan = io::read_height_field(input.file, options);
  if (!quiet)
    for (const std::string& note : scan.notes) print_note(fmt::format("{}: {}", input.file, note));
  return scan;
}

void add_surface_output(CLI::App& app, std::optional<std::string>& output) {
  app.add_option("-o,--output", output, "The surface: .gsf, .tif, .txt or .vti")->type_name("FILE");
}

std::map<std::string, std::string> provenance_of(const std::string& command,
                                                 const std::map<std::string, std::string>& options,
                                                 const std::vector<std::string>& inputs) {
  std::map<std::string, std::string> made;
  made["semsurf.version"] = workflow::version();
  made["command"] = command;
  for (const auto& [name, value] : options) made["option." + name] = value;
  int number = 0;
  for (const std::string& input : inputs)
    made[fmt::format("input.{}", ++number)] =
        fmt::format("{} sha256 {}", std::filesystem::path(input).filename().string(), io::sha256_of_file(input));
  return made;
}

}  // namespace surf::cli
