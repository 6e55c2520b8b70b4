// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "bound_parameters.h"
#include "surf/io/sim/materials.h"
#include "surf/workflow/train_job.h"

namespace surf::cli {

/// The files that a training reads, and the name of its material.
struct TrainFiles {
  std::vector<std::string> heights, images, signals;
  io::MaterialChoice material;
};
void describe(ParameterVisitor& visit, TrainFiles& files);

struct TrainOptions {
  BoundParameters bound;
  bool quiet = false;
};

void add_train_options(CLI::App& app, TrainOptions& options);

/// The job; numbers are looked at before files are read. Throws UsageError, FileError.
workflow::TrainJob make_train_job(const TrainOptions& options);

}  // namespace surf::cli
