// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "surf/sem/trained_model.h"

namespace surf::io {

/// Reads a model file: JSON for people and programs, see docs/how-to/training.md. Unknown keys are
/// ignored. Throws FileError, naming the field, if a field is missing, not finite or out of range,
/// if the kind of model is unknown, or if the file is of a newer version.
TrainedModel read_model(const std::filesystem::path& path);

/// Writes a model with every digit: equal models give equal bytes, and a file reads back to the
/// same model. The file appears under its name only when it is complete. Throws FileError,
/// UsageError for a name that does not end in .json, InvalidInput for numbers that are not finite
/// (an infinite condition number can be stored).
void write_model(const std::filesystem::path& path, const TrainedModel& model);

/// Throws what `write_model` would throw for the name or folder, before any work is spent.
void check_model_target(const std::filesystem::path& path);

/// Whether a file declares itself a model. False for files that cannot be read.
bool is_model_file(const std::filesystem::path& path);

/// The kind of a model as its file names it, such as "filter bank".
std::string kind_of(const TrainedModel& model);

}  // namespace surf::io
