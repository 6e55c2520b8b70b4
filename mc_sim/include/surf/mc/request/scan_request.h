// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

namespace surf {
class ParameterVisitor;
}

namespace surf::mc {

/// What the user asks of the scan. Any two of size, pixel size and region define it; the specimen's
/// extent gives what is missing (surf/workflow/simulate_job.h).
struct ScanRequest {
  std::optional<int> width, height;  ///< pixels
  std::optional<double> pixel_x_nm, pixel_y_nm;
  struct Region {
    double x0_nm, y0_nm, x1_nm, y1_nm;
  };  ///< outer pixel edges
  std::optional<Region> region;
};

/// Reading replaces what was there; where that leaves all three, the one that was there and least
/// changes the picture gives way.
void describe(ParameterVisitor& visit, ScanRequest& scan);

}  // namespace surf::mc
