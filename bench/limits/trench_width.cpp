// SPDX-License-Identifier: GPL-3.0-or-later
// Trenches too narrow for the tip: how far the eroded scan is off at their floor, and what the
// certainty map says there.
#include <cmath>
#include <vector>

#include "surf/afm/certainty.h"
#include "surf/afm/morphology.h"
#include "surf/afm/noise.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/units.h"
#include "surf/mesh/shapes.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

constexpr double depth_nm = 40, noise_nm = 0.2, wall_run_nm = 2;

struct Judged {
  double floor_error_nm = 0, floor_certain = 0;
  double wrong_flagged =
      1;  ///< of samples more than the bound off, the share that is not called certain
  double certain_wrong = 0;  ///< of certain samples, the share that is more than the bound off
  double certain_broken =
      0;  ///< the same, and so is every other sample of the square that the map names
};

Judged judge(const HeightField& truth, const HeightField& image, const Tip& tip,
             const CertaintyOptions& options) {
  const CertaintyMap map = certainty_map(image, tip, options);
  const double bound_nm = std::max(options.sigmas * options.noise_nm, 1e-3);
  const int w = truth.z_nm.width(), h = truth.z_nm.height();
  const auto off = [&](int x, int y) {
    return std::abs(map.surface.z_nm(x, y) - truth.z_nm(x, y)) > bound_nm;
  };
  Judged j;
  double floor = 0, wrong = 0, wrong_certain = 0, broken = 0, all_certain = 0;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const int level = map.level(x, y);
      const bool certain = level != CertaintyMap::uncertain;
      all_certain += certain, wrong += off(x, y), wrong_certain += off(x, y) && certain;
      if (certain) {
        bool all_off = true;  // the square of contacts holds this sample, and is 2 level + 1 across
        for (int v = std::max(0, y - 2 * level); v <= std::min(h - 1, y + 2 * level) && all_off;
             ++v)
          for (int u = std::max(0, x - 2 * level); u <= std::min(w - 1, x + 2 * level) && all_off;
               ++u)
            all_off = off(u, v);
        broken += all_off;
      }
      if (truth.z_nm(x, y) > -depth_nm + 1e-6) continue;
      floor += 1, j.floor_error_nm += map.surface.z_nm(x, y) - truth.z_nm(x, y),
          j.floor_certain += certain;
    }
  j.floor_error_nm /= floor, j.floor_certain /= floor;
  if (wrong > 0) j.wrong_flagged = (wrong - wrong_certain) / wrong;
  if (all_certain > 0)
    j.certain_wrong = wrong_certain / all_certain, j.certain_broken = broken / all_certain;
  return j;
}

std::vector<double> at(double width_nm) {
  const HeightField truth = make_trench({160, 60, 1}, depth_nm, width_nm, wall_run_nm);
  const Tip tip = conical_tip(8, 20 * degrees_to_radians, {1, 1, 61, 61});
  HeightField image = dilate(truth, tip);
  const Judged clean = judge(truth, image, tip, {});
  const Grid<double> e =
      simulate_noise({0, noise_nm * noise_nm}, image.z_nm.width(), image.z_nm.height(), 1);
  for (std::size_t k = 0; k < e.size(); ++k) image.z_nm.data()[k] += e.data()[k];
  CertaintyOptions options;
  options.noise_nm = noise_nm;
  const Judged noisy = judge(truth, image, tip, options);
  options.neighbourhood = 0;
  const Judged strict = judge(truth, image, tip, options);
  return {clean.floor_error_nm, clean.floor_certain,  clean.wrong_flagged,  clean.certain_wrong,
          noisy.floor_error_nm, noisy.floor_certain,  noisy.wrong_flagged,  noisy.certain_wrong,
          noisy.certain_broken, strict.floor_certain, strict.wrong_flagged, strict.certain_wrong};
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "Trenches 40 nm deep";
  out.panels = {panel(t, "", {"width of the floor (nm)", true, {}}, {"share", false, {}},
                      {{"floor_certain", "floor, certain"},
                       {"noisy_floor_certain", "floor, certain, with noise"},
                       {"noisy_certain_wrong", "certain and wrong, noise"},
                       {"strict_certain_wrong", "neighbourhood 0", true}})};
  return out;
}

}  // namespace

Sweep trench_width() {
  return {"trench_width",
          "trenches that the tip does not reach the floor of",
          {"width_nm", "floor_error_nm", "floor_certain", "wrong_flagged", "certain_wrong",
           "noisy_floor_error_nm", "noisy_floor_certain", "noisy_wrong_flagged",
           "noisy_certain_wrong", "noisy_certain_broken", "strict_floor_certain",
           "strict_wrong_flagged", "strict_certain_wrong"},
          {2, 4, 6, 8, 12, 16, 20, 24, 28, 32, 36, 40, 48, 64, 80},
          at,
          36,
          1e-6,
          plot};
}

}  // namespace surf::limits
