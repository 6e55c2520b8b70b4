// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "surf/core/parameters.h"
#include "surf/core/progress.h"
#include "surf/workflow/reporter.h"

class vtkAlgorithm;
class vtkDataObject;

namespace surf::pv {

/// Who hears a job that `work` runs on a thread of its own: `watch` is told of the progress,
/// `warnings` keeps what `warn` can say when it has ended. Notes are dropped.
workflow::Reporter hear(const Watch& watch, std::vector<std::string>& warnings);

/// Says them all.
void warn(vtkAlgorithm* self, const std::vector<std::string>& warnings);

/// How the data were made, as files of the command of that name say it.
void add_record(vtkDataObject* data, const std::string& step, const Record& parameters);

}  // namespace surf::pv
