// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace surf::workflow {

/// A measured yield of a flat specimen at normal incidence.
struct MeasuredYield {
  std::string material;  ///< an element's symbol or a material's name
  double energy_ev = 0;  ///< > 0
  double yield = 0;      ///< per primary, >= 0
  bool backscattered = false;
};

/// Reads a CSV table with a header line: `element`, `energy_keV`, and `delta` (secondaries) or
/// `eta` (backscattered). Other columns are ignored. If there is a column `quantity`, only lines
/// with SE or BSE count. Throws FileError with the line.
std::vector<MeasuredYield> read_measured_yields(const std::filesystem::path& path);

}  // namespace surf::workflow
