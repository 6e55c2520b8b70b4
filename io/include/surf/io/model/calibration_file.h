// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "surf/sem/calibration.h"

namespace surf::io {

/// The content of a calibration file.
struct CalibrationFile {
  Calibration calibration;
  double range_nm = 0;  ///< range of the slowly varying gain fitted with it; 0: none
  std::map<std::string, std::string> notes;  ///< how the calibration was made
};

/// Writes JSON: {"semsurf": "calibration", "version": 1, "outcome": "trusted", "channels":
/// [{"name": "SE", "gain": 120.3, "stderr": 0.4}], "offset": {"value": -3.1, "stderr": 0.2} ...},
/// with the fields of `Calibration` under their own names. Infinite values are left out. Throws
/// FileError.
void write_calibration(const std::filesystem::path& path, const CalibrationFile& file);

/// Reads such a file, exact to the last digit. Throws FileError naming the place of a fault.
CalibrationFile read_calibration(const std::filesystem::path& path);

/// "trusted", "doubtful" or "undetermined".
const char* name(CalibrationOutcome outcome);

}  // namespace surf::io
