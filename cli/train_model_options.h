// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>
#include <string>

#include "surf/workflow/train_job.h"
#include "train_options.h"

namespace surf::cli {

/// The options of `train` that say what kind of model is learnt and how.
void add_train_model_options(CLI::App& app, TrainOptions& options);

/// What they say. Throws UsageError, also for options about images where the kind has none.
void add_model(const TrainOptions& options, workflow::TrainJob& job);

/// The kinds of models, a line each, for a footer.
std::string kinds_in_words();

}  // namespace surf::cli
