// SPDX-License-Identifier: GPL-3.0-or-later
// A trench that narrows until the tip no longer reaches its floor: what the SEM image adds there.
#include <cmath>

#include "libsurf/reconstruction/small_scene.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

constexpr double depth_nm = 60, edge_nm = 18;

struct Inside {
  double error_nm = 0, deviation_nm = 0, touched = 0, seen = 0, held_by_nothing = 0;
};

/// Over the trench, walls and all, less the rows at the borders.
Inside inside(const test::SmallScene& scene, const Reconstruction& r, const HeightField& surface,
              double width_nm) {
  Inside sum;
  double count = 0;
  const HeightField& truth = scene.truth;
  for (int y = 4; y < truth.z_nm.height() - 4; ++y)
    for (int x = 0; x < truth.z_nm.width(); ++x) {
      if (std::abs(truth.x_nm(x)) > width_nm / 2) continue;
      const double d = surface.z_nm(x, y) - truth.z_nm(x, y);
      const int held = r.data_support(x, y);
      sum.error_nm += d * d;
      sum.deviation_nm += r.deviation_nm(x, y) * r.deviation_nm(x, y);
      sum.touched += (held & 1) != 0;
      sum.seen += (held & 2) != 0;
      sum.held_by_nothing += held == 0;
      count += 1;
    }
  return {std::sqrt(sum.error_nm / count), std::sqrt(sum.deviation_nm / count), sum.touched / count,
          sum.seen / count, sum.held_by_nothing / count};
}

std::vector<double> at(double width_nm) {
  const test::SmallScene scene(5, 56, 32, 1, [&](Point2 p) {
    const auto edge = [](double d) { return 0.5 * (1 + std::erf(d / edge_nm)); };
    return depth_nm * (1 - edge(p.x + width_nm / 2) * edge(width_nm / 2 - p.x));
  });
  const Reconstruction both = reconstruct(&scene.afm, &scene.sem);
  // The scan alone, on the same samples: a gain of 0 leaves the SEM image without a say.
  SemData blind = scene.sem;
  blind.gains = {0};
  ReconstructionOptions o;
  o.double_precision = true;
  o.refine_transform = o.refine_calibration = false;
  const Reconstruction alone = reconstruct(&scene.afm, &blind, o);
  const Inside b = inside(scene, both, both.surface, width_nm),
               a = inside(scene, alone, alone.surface, width_nm);
  const Inside start = inside(scene, both, both.start, width_nm);
  const auto& left = both.scales.back();
  return {b.touched,
          start.error_nm,
          a.error_nm,
          a.deviation_nm,
          b.error_nm,
          b.deviation_nm,
          b.seen,
          b.held_by_nothing,
          left.afm_residual.like_noise && left.sem_residual.like_noise ? 0.0 : 1.0};
}

io::Plot plot(const Table& t) {
  const io::PlotAxis x{"width of the trench (nm), 60 nm deep", false, {}};
  io::Plot out;
  out.title = "What the tip does not touch: the floor of a trench (tip radius 80 nm)";
  out.panels = {panel(t, "", x, {"in the trench, rms (nm)", true, {}},
                      {{"start_nm", "error of the eroded scan"},
                       {"afm_nm", "error, AFM alone"},
                       {"afm_deviation_nm", "deviation that it gives", true},
                       {"both_nm", "error, both images"},
                       {"both_deviation_nm", "deviation that they give", true}}),
                panel(t, "", x, {"share of the trench", false, io::PlotAxis::Range{-0.04, 1.04}},
                      {{"touched", "touched by the tip"},
                       {"both_seen", "held by the SEM image"},
                       {"both_held_by_nothing", "held by nothing", true},
                       {"warned", "warned"}})};
  // One contact for each of the scan's pixels, of which there is one for four of the SEM's.
  out.panels[1].references.push_back({io::PlotDirection::horizontal, 0.25, "touched everywhere"});
  return out;
}

}  // namespace

Sweep reconstruction_untouched() {
  return {"reconstruction_untouched",
          "a trench that narrows until the tip does not touch its floor",
          {"width_nm", "touched", "start_nm", "afm_nm", "afm_deviation_nm", "both_nm",
           "both_deviation_nm", "both_seen", "both_held_by_nothing", "warned"},
          {50, 70, 90, 110, 130, 150, 180, 220, 260, 320},
          at,
          180,
          0.25,
          plot};
}

}  // namespace surf::limits
