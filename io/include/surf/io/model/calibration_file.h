// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "surf/sem/calibration.h"

namespace surf::io {

/// What a calibration file holds.
struct CalibrationFile {
  Calibration calibration;
  double range_nm = 0;  ///< of the slowly varying gain that went with it; 0: none
  std::map<std::string, std::string> notes;  ///< how it was made
};

/// Writes JSON: {"semsurf": "calibration", "version": 1, "outcome": "trusted", "channels":
/// [{"name": "SE", "gain": 120.3, "stderr": 0.4}], "offset": {"value": -3.1, "stderr": 0.2} ...},
/// with the fields of `Calibration` under their own names. What is infinite is left out. Throws
/// FileError.
void write_calibration(const std::filesystem::path& path, const CalibrationFile& file);

/// Reads it again, to the last digit. Throws FileError naming the place of a fault.
CalibrationFile read_calibration(const std::filesystem::path& path);

/// "trusted", "doubtful" or "undetermined".
const char* name(CalibrationOutcome outcome);

}  // namespace surf::io
