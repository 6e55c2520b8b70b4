// SPDX-License-Identifier: GPL-3.0-or-later
// A start that is off by some pixels: from how far the registration finds the place, and what it
// says otherwise.
#include <cmath>
#include <numbers>

#include "registration_outcomes.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

std::vector<double> at(double off_px) {
  return registered_from([&](const Affine& truth, RandomStream& random) {
    const double toward = 2 * std::numbers::pi * random.uniform();
    return compose(truth, {1, 0, off_px * std::cos(toward), 0, 1, off_px * std::sin(toward)});
  });
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "Registration from a start that is displaced";
  out.panels = {panel_of_starts(t, "120 x 90 SEM pixels, spots 3 to 9 pixels wide",
                                {"start off by (SEM pixels)", false, {}})};
  return out;
}

}  // namespace

Sweep registration_start() {
  std::vector<std::string> columns = columns_from_starts();
  columns.insert(columns.begin(), "off_px");
  return {"registration_start",
          "registration from a start that is displaced by some pixels",
          columns,
          {0, 4, 6, 8, 10, 12, 14, 16, 20, 25, 30, 40, 60},
          at,
          14,
          1e-6,
          plot};
}

}  // namespace surf::limits
