// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "surf/sem/trained_model.h"

namespace surf::cli {

/// "Si, 1 keV, pixels of 3 nm, spot 0 nm".
std::string format_scope(const ModelScope& scope);

/// "filter bank, 10 neighbourhoods of 5 to 83 samples, SE and BSE".
std::string format_model(const TrainedModel& model);

/// How many of its surfaces a model has learnt from: not those held out.
std::size_t learnt_from(const TrainingRecord& record);

/// How far a model is off, a line per surface and then for all, in columns per channel: the root
/// mean square with the noise subtracted and the mean deviation with it, both in % of the mean
/// signal, which comes first. Empty if it was never judged.
std::vector<std::string> residual_table(const TrainingRecord& record);

/// "slopes to 83 deg (99 %: 71), curvatures to 1.2 per nm (99 %: 0.3)".
std::string format_range(const SurfaceRange& range);

}  // namespace surf::cli
