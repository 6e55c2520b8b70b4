// SPDX-License-Identifier: GPL-3.0-or-later
// A start that is turned: from how far the registration finds the place, and what it says
// otherwise.
#include <numbers>

#include "registration_outcomes.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

std::vector<double> at(double off_deg) {
  return registered_from([&](const Affine& truth, RandomStream& random) {
    const double turn = (random.uniform() < 0.5 ? -1 : 1) * off_deg * std::numbers::pi / 180;
    return compose(truth, make_affine({turn, 1, 1, 0, 0, 0}));
  });
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "Registration from a start that is turned";
  out.panels = {panel_of_starts(t, "120 x 90 SEM pixels, spots 3 to 9 pixels wide",
                                {"start turned by (degrees)", false, {}})};
  return out;
}

}  // namespace

Sweep registration_turn() {
  std::vector<std::string> columns = columns_from_starts();
  columns.insert(columns.begin(), "off_deg");
  return {"registration_turn",
          "registration from a start that is turned by some degrees",
          columns,
          {0, 5, 10, 15, 20, 25, 30, 40, 60, 90, 180},
          at,
          20,
          1e-6,
          plot};
}

}  // namespace surf::limits
