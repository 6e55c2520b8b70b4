// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "surf/sem/trained_model.h"

namespace surf::io {

/// Reads a model file: JSON for people and programs, see docs/methods/training.md. Keys that are
/// not known are passed over. Throws FileError, naming the field, where one is missing, not finite
/// or out of range, where the kind of model is unknown, or the file is of a newer version.
TrainedModel read_model(const std::filesystem::path& path);

/// Writes a model, with every digit: the same model gives the same bytes, and reads back as it was.
/// The file appears under its name only when it is complete. Throws FileError, UsageError for a
/// name that does not end in .json, InvalidInput for numbers that are not finite (an infinite
/// condition number is one that files can hold).
void write_model(const std::filesystem::path& path, const TrainedModel& model);

/// Throws what `write_model` would for the name or folder, before any work is spent.
void check_model_target(const std::filesystem::path& path);

/// Whether a file says that it is a model. False for what cannot be read.
bool is_model_file(const std::filesystem::path& path);

/// The kind of a model as its file names it: "filter bank".
std::string kind_of(const TrainedModel& model);

}  // namespace surf::io
