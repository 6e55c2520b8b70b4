// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>
#include <utility>

#include "surf/core/parameters.h"
#include "surf/io/height_field_file.h"
#include "surf/io/sem_file.h"

namespace surf::io {

/// How a scan file is read: scan.height_channel, scan.height_unit and scan.height_pitch.
void describe(ParameterVisitor& visit, HeightReadOptions& options);

/// How an SEM image is read: scan.sem_channel and scan.pixel_size.
void describe(ParameterVisitor& visit, SemReadOptions& options);

/// Parses "2nm" for square samples, or "2nmx3nm". Throws UsageError naming `subject`.
std::pair<double, double> parse_pitch_nm(std::string_view text, std::string_view subject);

/// Parses the length of a file's unit, "um" or "25.4mm", and returns it in nm. Throws UsageError
/// naming `subject`.
double parse_unit_nm(std::string_view text, std::string_view subject);

}  // namespace surf::io
