// SPDX-License-Identifier: GPL-3.0-or-later
// A lattice of dots with something that does not repeat beside it, less and less: whether the place
// is found, and what is said where it is not.
#include <cmath>

#include "registration_outcomes.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

constexpr int width = 160, height = 120, scan = 160;
constexpr double period = 12;

std::vector<double> at(double unique) {
  constexpr std::uint64_t scenes = 4;
  Outcomes searched, led;
  const test::Scene dots = test::lattice_of(period);
  for (std::uint64_t seed = 1; seed <= scenes; ++seed) {
    const test::Spots spots(seed);
    const test::Scene scene = [&](double x, double y) {
      return dots(x, y) + unique * spots(x / 3, y / 3);
    };
    const Affine truth = make_affine({0.7, 1.02, 0.98, 0.01, 9, -7});
    const PlacedImage sem = test::image_of(scene, truth, width, height, 1, 0.3, 2 * seed);
    const PlacedImage afm = test::image_of(scene, {}, scan, scan, 1, 0.03, 2 * seed + 1);
    const auto add = [&](Outcomes& to, const RegistrationOptions& options) {
      const Registration r = register_images(sem, afm, options);
      to.add(r, test::error_px(truth, r.sem_to_afm, width, height, 0.5 * scan));
    };
    RegistrationOptions options;
    options.least_scale = 0.95, options.largest_scale = 1.05,
    options.largest_shear = 0.02;  // pixel sizes are known
    add(searched, options);
    // Landmarks, and blurs that leave the pattern there.
    options.blurs_px = {3, 2, 1, 0};
    options.start = make_affine({0.705, 1.02, 0.975, 0.01, 10, -8});
    add(led, options);
  }
  std::vector<double> row = searched.shares();
  row.insert(row.end(), {led.verified_right(), led.verified_wrong()});
  return row;
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "Registration of a lattice: what does not repeat beside it";
  out.panels = {panel(t, "dots 12 SEM pixels apart, 160 x 120 pixels",
                      {"what does not repeat, relative to the dots", true, {}},
                      {"share of 4 scenes", false, io::PlotAxis::Range{-0.04, 1.04}},
                      {{"verified_right", "right, verified: searched"},
                       {"verified_wrong", "WRONG, verified: searched"},
                       {"ambiguous", "ambiguous: searched"},
                       {"refused", "unconverged or unrelated: searched"},
                       {"led_right", "right, verified: from landmarks within 1.5 pixels", true}})};
  return out;
}

}  // namespace

Sweep registration_repeats() {
  return {"registration_repeats",
          "registration of a lattice with less and less that does not repeat",
          {"unique", "verified_right", "verified_wrong", "ambiguous", "refused", "led_right",
           "led_wrong"},
          {0.001, 0.01, 0.03, 0.1, 0.2, 0.4, 0.7, 1, 2, 4},
          at,
          0.4,
          1e-6,
          plot};
}

}  // namespace surf::limits
