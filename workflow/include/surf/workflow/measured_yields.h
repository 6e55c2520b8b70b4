// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace surf::workflow {

/// A yield of a flat specimen, seen from above, as somebody measured it.
struct MeasuredYield {
  std::string material;  ///< an element's symbol or a material's name
  double energy_ev = 0;  ///< > 0
  double yield = 0;      ///< per primary, >= 0
  bool backscattered = false;
};

/// Reads a table (CSV) with a line of names: `element`, `energy_keV`, and `delta` (secondaries) or
/// `eta` (backscattered); others are passed over, and with a column `quantity` all lines that say
/// other than SE or BSE. Throws FileError with the line.
std::vector<MeasuredYield> read_measured_yields(const std::filesystem::path& path);

}  // namespace surf::workflow
