// SPDX-License-Identifier: GPL-3.0-or-later
// Two images of which less and less shows the same: searched for with the usual least overlap, with
// a smaller one, and from a start near the truth.
#include <cmath>

#include "registration_outcomes.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

constexpr int width = 120, height = 100;

std::vector<double> at(double overlap) {
  constexpr std::uint64_t scenes = 4;
  Outcomes usual, small, led;
  for (std::uint64_t seed = 1; seed <= scenes; ++seed) {
    const test::Spots spots(seed);
    const Affine truth{1, 0, (1 - overlap) * width,
                       0, 1, 0};  // the scan's right part is the SEM's left part
    const PlacedImage sem = test::image_of(spots, truth, width, height, 1, 0.3, 2 * seed);
    const PlacedImage scan = test::image_of(spots, {}, width, height, 1, 0.03, 2 * seed + 1);
    const auto add = [&](Outcomes& to, const RegistrationOptions& options) {
      const Registration r = register_images(sem, scan, options);
      // Over what both show.
      double sum = 0, count = 0;
      for (int y = 0; y < height; y += 3)
        for (double x = 0; x < overlap * width; x += 3) {
          const Point2 p{x - 0.5 * (width - 1), y - 0.5 * (height - 1)}, is = r.sem_to_afm(p),
                                                                         should = truth(p);
          sum += (is.x - should.x) * (is.x - should.x) + (is.y - should.y) * (is.y - should.y);
          count += 1;
        }
      to.add(r, std::sqrt(sum / count));
    };
    RegistrationOptions options;
    options.least_scale = 0.95, options.largest_scale = 1.05,
    options.largest_shear = 0.02;  // pixel sizes are known
    add(usual, options);
    options.least_overlap = 0.1;
    add(small, options);
    options.start = compose(truth, make_affine({0.03, 1.01, 0.99, 0, 2, -2}));
    add(led, options);
  }
  std::vector<double> row = usual.shares();
  row.insert(row.end(), {small.verified_right(), small.verified_wrong(), led.verified_right(),
                         led.verified_wrong()});
  return row;
}

io::Plot plot(const Table& t) {
  const io::PlotAxis x{"share of the images that shows the same", false, {}};
  const io::PlotAxis y{"share of 4 scenes", false, io::PlotAxis::Range{-0.04, 1.04}};
  io::Plot out;
  out.title = "Registration with less and less overlap";
  out.panels = {panel(t, "searched for, as usual (least overlap 0.4)", x, y,
                      {{"verified_right", "right, verified"},
                       {"verified_wrong", "WRONG, verified"},
                       {"ambiguous", "ambiguous"},
                       {"refused", "unconverged or unrelated"}}),
                panel(t, "least overlap 0.1", x, y,
                      {{"small_right", "right, verified: searched"},
                       {"small_wrong", "WRONG, verified: searched"},
                       {"led_right", "right, verified: from landmarks", true},
                       {"led_wrong", "WRONG, verified: from landmarks", true}})};
  return out;
}

}  // namespace

Sweep registration_overlap() {
  return {"registration_overlap",
          "registration of images that share less and less",
          {"overlap", "verified_right", "verified_wrong", "ambiguous", "refused", "small_right",
           "small_wrong", "led_right", "led_wrong"},
          {1, 0.6, 0.5, 0.4, 0.35, 0.3, 0.2, 0.1},
          at,
          0.35,
          1e-6,
          plot};
}

}  // namespace surf::limits
