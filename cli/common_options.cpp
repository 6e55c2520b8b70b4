// SPDX-License-Identifier: GPL-3.0-or-later
#include "common_options.h"

#include "surf/mc/simulate.h"

namespace surf::cli {

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
