// SPDX-License-Identifier: GPL-3.0-or-later
// Landmarks on a lattice: a start that is off by half a period leads to the next dot. Whether that
// is said.
#include <cmath>

#include "registration_outcomes.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

constexpr int width = 120, height = 90, scan = 120;
constexpr double period = 12;

std::vector<double> at(double off_px) {
  constexpr std::uint64_t scenes = 8;
  Outcomes usual, narrow;
  const test::Scene dots = test::lattice_of(period);
  for (std::uint64_t seed = 1; seed <= scenes; ++seed) {
    const test::Spots spots(seed);
    const test::Scene scene = [&](double x, double y) {
      return dots(x, y) + 0.2 * spots(x / 3, y / 3);
    };
    const Affine truth = make_affine({0.3, 1, 1, 0, 4, -3});
    const PlacedImage sem = test::image_of(scene, truth, width, height, 1, 0.3, 2 * seed);
    const PlacedImage afm = test::image_of(scene, {}, scan, scan, 1, 0.03, 2 * seed + 1);
    RegistrationOptions options;
    options.start = compose(Affine{1, 0, off_px, 0, 1, 0}, truth);  // along a row of dots
    const auto add = [&](Outcomes& to) {
      const Registration r = register_images(sem, afm, options);
      to.add(r, test::error_px(truth, r.sem_to_afm, width, height, 0.5 * scan));
    };
    add(usual);
    options.blurs_px = {3, 2, 1, 0};
    add(narrow);
  }
  std::vector<double> row = usual.shares();
  for (const double share : narrow.shares()) row.push_back(share);
  return row;
}

io::Plot plot(const Table& t) {
  const io::PlotAxis x{"start off along a row of dots (SEM pixels)", false, {}};
  const io::PlotAxis y{"share of 8 scenes", false, io::PlotAxis::Range{-0.04, 1.04}};
  io::Plot out;
  out.title = "Landmarks on a lattice, dots 12 SEM pixels apart";
  out.panels = {panel(t, "usual blurs, 8 to 0 pixels", x, y,
                      {{"verified_right", "right, verified"},
                       {"verified_wrong", "WRONG, verified"},
                       {"ambiguous", "ambiguous"},
                       {"refused", "unconverged or unrelated"}}),
                panel(t, "blurs 3, 2, 1, 0: the pattern is seen", x, y,
                      {{"narrow_right", "right, verified"},
                       {"narrow_wrong", "WRONG, verified"},
                       {"narrow_ambiguous", "ambiguous"},
                       {"narrow_refused", "unconverged or unrelated"}})};
  return out;
}

}  // namespace

Sweep registration_lattice() {
  return {"registration_lattice",
          "registration of a lattice from landmarks that are off",
          {"off_px", "verified_right", "verified_wrong", "ambiguous", "refused", "narrow_right",
           "narrow_wrong", "narrow_ambiguous", "narrow_refused"},
          {0, 2, 4, 5, 6, 7, 8, 10, 12, 18},
          at,
          7,
          1e-6,
          plot};
}

}  // namespace surf::limits
