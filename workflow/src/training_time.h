// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/workflow/reporter.h"
#include "surf/workflow/train_job.h"

namespace surf::workflow {

/// Seconds that a training on generated surfaces takes on this machine with nothing beside it. Its
/// first missing images are simulated and stay in the image folder, so that no time is lost, and a
/// few steps of learning on them are timed. Throws Interrupted, and what `run` throws for the job.
double expected_training_s(const TrainJob& job, const Reporter& reporter);

}  // namespace surf::workflow
