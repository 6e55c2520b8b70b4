// SPDX-License-Identifier: GPL-3.0-or-later
#include "afm_options.h"

#include <fmt/format.h>

#include "job_reporter.h"
#include "surf/core/error.h"

namespace surf::cli {

void add_height_reading(CLI::App& app, BoundParameters& bound, const std::string& group) {
  bound.looks["scan.height_channel"].former = {"--channel"};
  bound.looks["scan.height_unit"].former = {"--z-unit"};
  bound.looks["scan.height_pitch"].former = {"--pixel-size"};
  bound.add<io::HeightReadOptions>(app, group);
}

void add_scan_input(CLI::App& app, BoundParameters& bound, std::string& file,
                    const std::string& group) {
  CLI::Option* input =
      with_role(app.add_option("INPUT", file, "A scan of any format, or an image of heights")
                    ->type_name("FILE"),
                FileRole::read);
  if (group.empty()) input->group("");
  add_height_reading(app, bound, group);
}

io::HeightFieldFile read_scan(const std::string& file, const io::HeightReadOptions& options,
                              bool quiet) {
  if (file.empty()) throw UsageError("INPUT", "no scan is given", "Name a file to read");
  io::HeightFieldFile scan = io::read_height_field(file, options);
  const JobReporter reporter(quiet);
  for (const std::string& note : scan.notes) reporter->note(fmt::format("{}: {}", file, note));
  return scan;
}

void add_surface_output(CLI::App& app, std::optional<std::string>& output) {
  with_role(app.add_option("-o,--output", output, "The surface: .gsf, .tif, .txt or .vti")
                ->type_name("FILE"),
            FileRole::written);
}

}  // namespace surf::cli
