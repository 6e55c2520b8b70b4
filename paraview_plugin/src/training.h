// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "surf/core/progress.h"
#include "surf/workflow/train_job.h"

class vtkTable;

namespace surf::pv {

/// Trains; what is good to know is added to `notes`. Throws Interrupted, also where there is no
/// model yet.
workflow::TrainSummary train(const workflow::TrainJob& job, const Watch& watch,
                             std::vector<std::string>& notes);

/// A row for each surface, then for all that were learnt from and all held out, as the command's
/// table.
void fill_errors(vtkTable* table, const TrainingRecord& record);

/// "quantity" and "value": what the model is, where it is from, and the notes.
void fill_model(vtkTable* table, const workflow::TrainJob& job,
                const workflow::TrainSummary& summary, const std::vector<std::string>& notes);

}  // namespace surf::pv
