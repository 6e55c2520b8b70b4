// SPDX-License-Identifier: GPL-3.0-or-later
// Landmarks that are read off inexactly: how wrong four of them may be for the registration to find
// the place.
#include <cmath>
#include <numbers>

#include "registration_outcomes.h"
#include "surf/registration/landmarks.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

std::vector<double> at(double off_px) {
  return registered_from([&](const Affine& truth, RandomStream& random) {
    std::vector<LandmarkPair> pairs;
    for (const Point2 p : {Point2{-40, -30}, {40, -30}, {40, 30}, {-40, 30}}) {
      // Normal along each axis.
      const double size = off_px * std::sqrt(-2 * std::log(random.uniform()));
      const double toward = 2 * std::numbers::pi * random.uniform();
      pairs.push_back({{p.x + size * std::cos(toward), p.y + size * std::sin(toward)}, truth(p)});
    }
    return fit_landmarks(pairs).sem_to_afm;
  });
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "Registration from four landmarks that are off";
  out.panels = {panel_of_starts(t, "80 x 60 SEM pixels apart",
                                {"standard deviation of a landmark (SEM pixels)", false, {}})};
  return out;
}

}  // namespace

Sweep registration_landmarks() {
  std::vector<std::string> columns = columns_from_starts();
  columns.insert(columns.begin(), "off_px");
  return {"registration_landmarks",
          "registration from four landmarks that are off by some pixels each",
          columns,
          {0, 3, 6, 10, 15, 20, 30},
          at,
          10,
          1e-6,
          plot};
}

}  // namespace surf::limits
