// SPDX-License-Identifier: GPL-3.0-or-later
#include "common_options.h"

#include "surf/mc/simulate.h"

namespace surf::cli {

void add_unit_options(CLI::App& app, std::optional<std::string>& unit, bool& overrides, const std::string& group) {
  app.add_option("--unit", unit, "Length of one unit of the mesh files (as they say, else nm; glTF: m)")
      ->type_name("nm|um|mm|m|pm|A|in")->group(group);
  app.add_flag("--override-unit", overrides, "Take --unit even where a file says another unit")->group(group);
}

void add_threads_option(CLI::App& app, BoundParameters& bound, const std::string& group) {
  bound.add<mc::Execution>(app, group);
}

int threads_of(const BoundParameters& bound) {
  mc::Execution execution;
  bound.apply(execution);
  return execution.threads;
}

CLI::Option* add_quiet_flag(CLI::App& app, bool& quiet) {
  return app.add_flag("-q,--quiet", quiet, "Only errors and warnings");
}

}  // namespace surf::cli
