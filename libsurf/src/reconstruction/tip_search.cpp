// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/reconstruction/tip_search.h"

#include <nlopt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "initial_surface.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"
#include "surf/sem/calibration.h"
#include "tip_family.h"

namespace surf {
namespace {

using namespace reconstruction;

constexpr double radians = std::numbers::pi / 180;
constexpr double usual_half_angle_deg = 25;
constexpr double radii_nm[] = {10, 15, 25, 35, 50, 70, 90, 120, 160, 200};
constexpr int most_tries = 500;
constexpr std::int64_t least_pixels = 256;
constexpr int most_reach = 40;  // samples from the apex
// Pixels that share an error of the model.
constexpr double pixels_that_err_together = 50;

// Numbers of a try, each in units of how far it may well be from the usual one.
enum Number { radius, angle, lean_x, lean_y, wide_x, wide_y, first_of_map };
constexpr int numbers = first_of_map + affine_numbers;
constexpr double unit_of_angle_deg = 8, unit_of_waves = 0.2, unit_of_map_px = 3;
using Numbers = std::array<double, numbers>;  // the radius as its logarithm

class Search {
 public:
  Search(const HeightField& scan, const PlacedImage& sem, const ImageModel& model,
         const Affine& map, int threads, const Watch& watch)
      : scan_(scan), sem_(sem), model_(model), map_(map), threads_(threads), watch_(watch) {
    const int w = sem.values.width(), h = sem.values.height();
    used_ = Mask(w, h);
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        const Point2 p = map({sem.x_nm(x), sem.y_nm(y)});
        const double u = (p.x - scan.origin_x_nm) / scan.pitch_x_nm,
                     v = (p.y - scan.origin_y_nm) / scan.pitch_y_nm;
        used_(x, y) = sem.is_valid(x, y) && u >= 0 && v >= 0 && u <= scan.z_nm.width() - 1 &&
                      v <= scan.z_nm.height() - 1;
        pixels_ += used_(x, y);
      }
    if (pixels_ < least_pixels)
      throw InvalidInput("registration", "the images hardly overlap", "Check the transform");
    const auto [low, high] = std::ranges::minmax_element(scan.z_nm.data());
    depth_nm_ = *high - *low;
  }

  Tip tip(const Numbers& n) const {
    const double r = std::exp(n[radius]), half_angle = half_angle_deg(n) * radians;
    const double kink_nm = r * (1 - std::sin(half_angle));
    const double reach_nm = 1.5 * (r * std::cos(half_angle) +
                                   std::max(0.0, depth_nm_ - kink_nm) * std::tan(half_angle));
    const auto size = [&](double pitch_nm, int samples) {
      const int reach = std::clamp(static_cast<int>(std::ceil(reach_nm / pitch_nm)), 2, most_reach);
      return 2 * std::min(reach, (samples - 1) / 4) + 1;
    };
    const Tip round =
        conical_tip(r, half_angle,
                    {scan_.pitch_x_nm, scan_.pitch_y_nm, size(scan_.pitch_x_nm, scan_.z_nm.width()),
                     size(scan_.pitch_y_nm, scan_.z_nm.height())});
    TipChange change{};
    for (int place = 0; place < tip_places; ++place)
      for (int wave = 1; wave < tip_waves; ++wave)
        change[static_cast<std::size_t>(place * tip_waves + wave)] =
            unit_of_waves * n[static_cast<std::size_t>(lean_x + wave - 1)];
    return TipFamily(round).changed(round, change);
  }

  double half_angle_deg(const Numbers& n) const {
    return std::clamp(usual_half_angle_deg + unit_of_angle_deg * n[angle], 5.0, 60.0);
  }

  /// The map moved by shifts and linear changes about the image's middle, in pixels at its border.
  Affine map(const Numbers& n) const {
    const double reach_x = 0.5 * sem_.values.width() * sem_.pitch_x_nm,
                 reach_y = 0.5 * sem_.values.height() * sem_.pitch_y_nm,
                 middle_x = sem_.x_nm(0) + reach_x, middle_y = sem_.y_nm(0) + reach_y;
    const auto change = [&](int k) {
      return unit_of_map_px * sem_.pitch_x_nm * n[static_cast<std::size_t>(first_of_map + k)];
    };
    Affine m = map_;
    m.xx += change(1) / reach_x;
    m.xy += change(2) / reach_y;
    m.x0 += change(0) - change(1) * middle_x / reach_x - change(2) * middle_y / reach_y;
    m.yx += change(4) / reach_x;
    m.yy += change(5) / reach_y;
    m.y0 += change(3) - change(4) * middle_x / reach_x - change(5) * middle_y / reach_y;
    return m;
  }

  double residual(const Tip& tip, const Affine& map) const { return fit(tip, map).residual_rms; }

  /// The best of the round tips.
  double evidence() const {
    double best = 0;
    for (const double r : radii_nm) {
      const double explained = std::min(fit(tip({std::log(r)}), map_).explained, 1 - 1e-9);
      best = std::max(best, -0.5 * static_cast<double>(pixels_) / pixels_that_err_together *
                                std::log1p(-explained));
    }
    return best;
  }

  Calibration fit(const Tip& tip, const Affine& map) const {
    watch_.check();
    AfmData afm;
    afm.image = scan_;
    afm.tip = tip;
    const SurfaceFrame frame{sem_.values.width(), sem_.values.height(), sem_.pitch_x_nm,
                             sem_.origin_x_nm, sem_.origin_y_nm};
    CalibrationImages images;
    images.real = sem_.values;
    images.used = used_;
    images.channels = model_.channels();
    images.simulated = model_.predict(frame.field(on_frame(eroded(afm, threads_), frame, map)),
                                      {.threads = threads_});
    CalibrationOptions one;
    one.ratios.assign(images.channels.size(), 1);
    return calibrate(images, one);
  }

  double badness(const Numbers& n) {
    double sum = static_cast<double>(pixels_) / pixels_that_err_together *
                 std::log(residual(tip(n), map(n)));
    for (int k = angle; k < numbers; ++k)
      sum += 0.5 * n[static_cast<std::size_t>(k)] * n[static_cast<std::size_t>(k)];
    if (++tries_ <= most_tries) watch_.report(tries_, most_tries);
    if (sum < least_) least_ = sum, best_ = n;
    return sum;
  }

  Numbers run() {
    for (const double r : radii_nm) badness({std::log(r)});
    Numbers at = best_, steps;
    steps.fill(0.3);
    steps[radius] = 0.15;
    const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> optimiser(
        nlopt_create(NLOPT_LN_BOBYQA, numbers), nlopt_destroy);
    nlopt_set_min_objective(
        optimiser.get(),
        [](unsigned, const double* x, double*, void* self) {
          Numbers n;
          std::copy_n(x, numbers, n.begin());
          return static_cast<Search*>(self)->asked(n);
        },
        this);
    optimiser_ = optimiser.get();
    Numbers low, high;
    low.fill(-4), high.fill(4);
    low[radius] = 0, high[radius] = std::log(1000.0);
    nlopt_set_lower_bounds(optimiser.get(), low.data());
    nlopt_set_upper_bounds(optimiser.get(), high.data());
    nlopt_set_initial_step(optimiser.get(), steps.data());
    nlopt_set_maxeval(optimiser.get(), most_tries);
    nlopt_set_ftol_abs(optimiser.get(), 0.02);
    double least = 0;
    nlopt_optimize(optimiser.get(), at.data(), &least);
    if (failure_) std::rethrow_exception(failure_);
    return best_;
  }

 private:
  /// Nothing may be thrown through the library.
  double asked(const Numbers& n) {
    try {
      return badness(n);
    } catch (...) {
      failure_ = std::current_exception();
      nlopt_force_stop(optimiser_);
      return 0;
    }
  }

  const HeightField& scan_;
  const PlacedImage& sem_;
  const ImageModel& model_;
  Affine map_;
  int threads_;
  const Watch& watch_;
  Mask used_;
  std::int64_t pixels_ = 0;
  double depth_nm_ = 0;
  int tries_ = 0;
  double least_ = HUGE_VAL;
  Numbers best_{};
  nlopt_opt optimiser_ = nullptr;
  std::exception_ptr failure_;
};

}  // namespace

double place_evidence(const HeightField& scan, const PlacedImage& sem, const ImageModel& model,
                      const Affine& sem_to_afm, int threads, const Watch& watch) {
  return Search(scan, sem, model, sem_to_afm, threads, watch).evidence();
}

double beyond(const TipBound& bound, const Tip& tip) {
  if (!(bound.threshold_nm > 0)) return 0;
  const Grid<double>& limit = bound.tip.z_nm;
  double squares = 0;
  for (int y = 0; y < tip.z_nm.height(); ++y)
    for (int x = 0; x < tip.z_nm.width(); ++x) {
      const int column = x - tip.apex_x + bound.tip.apex_x, row = y - tip.apex_y + bound.tip.apex_y;
      if (column < 1 || row < 1 || column + 1 >= limit.width() || row + 1 >= limit.height())
        continue;
      double duller = limit(column, row);
      for (int v = -1; v <= 1; ++v)
        for (int u = -1; u <= 1; ++u) duller = std::max(duller, limit(column + u, row + v));
      const double over = (tip.z_nm(x, y) - duller) / bound.threshold_nm - 1;
      if (over > 0) squares += over * over;
    }
  return std::sqrt(squares);
}

FoundTip find_tip_by_sem(const HeightField& scan, const Tip& tip, const PlacedImage& sem,
                         const ImageModel& model, const Affine& sem_to_afm, int threads,
                         const Watch& watch) {
  Search search(scan, sem, model, sem_to_afm, threads, watch);
  FoundTip found;
  found.residual_before = search.residual(tip, sem_to_afm);
  const Numbers best = search.run();
  found.tip = search.tip(best);
  found.radius_nm = std::exp(best[radius]);
  found.half_angle_deg = search.half_angle_deg(best);
  found.lean = std::expm1(2 * unit_of_waves * std::hypot(best[lean_x], best[lean_y]));
  found.sem_to_afm = search.map(best);
  found.residual = search.residual(found.tip, found.sem_to_afm);
  return found;
}

}  // namespace surf
