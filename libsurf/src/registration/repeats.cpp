// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/repeats.h"

#include <algorithm>
#include <cmath>

#include "registration/shift_search.h"

namespace surf {
namespace {

constexpr double alike = 0.5;        // least correlation of the AFM's image with itself
constexpr double least_share = 0.5;  // share of the part that must stay in the AFM's image
constexpr double blur_per_sample = 2;
// In samples; transforms of larger images cost more than they gain.
constexpr double largest_side = 512;

/// The inverse of `place`: from places of the AFM's image to places of the SEM's image.
class WayBack {
 public:
  explicit WayBack(const ThreePointMap& c)
      : c_(c), determinant_((c[2] - c[0]) * (c[5] - c[1]) - (c[3] - c[1]) * (c[4] - c[0])) {}

  bool is_seen(const SmoothImage& sem, double x, double y) const {
    const double dx = x - c_[0], dy = y - c_[1];
    const double s = (dx * (c_[5] - c_[1]) - dy * (c_[4] - c_[0])) / determinant_;
    const double t = (dy * (c_[2] - c_[0]) - dx * (c_[3] - c_[1])) / determinant_;
    return sem.holds((2 * s - 1) * sem.half_width(), (2 * t - 1) * sem.half_height());
  }

 private:
  ThreePointMap c_;
  double determinant_;
};

}  // namespace

std::vector<ThreePointMap> repeats_of(const BlurLevel& level, const ThreePointMap& best,
                                      std::size_t wanted) {
  const double w = level.afm.half_width(), h = level.afm.half_height();
  const double pitch =
      std::max({1.0, level.blur_px / blur_per_sample, 2 * std::sqrt(w * h) / largest_side});
  const int columns = 1 + static_cast<int>(2 * w / pitch),
            rows = 1 + static_cast<int>(2 * h / pitch);
  const auto x_of = [&](int column) { return column * pitch - w; };
  const auto y_of = [&](int row) { return row * pitch - h; };
  const WayBack back(best);
  const auto value = [&](int i, int j) { return level.afm.value(x_of(i), y_of(j)); };
  const auto holds = [&](int i, int j) { return level.afm.holds(x_of(i), y_of(j)); };
  const MaskedGrid part = sampled(columns, rows, value, [&](int i, int j) {
    return holds(i, j) && back.is_seen(level.sem, x_of(i), y_of(j));
  });
  const ShiftSearch shifts(sampled(columns, rows, value, holds), least_share, {{columns, rows}});
  std::vector<ThreePointMap> repeats;
  // The highest peak is the part at its own place.
  for (const ShiftPeak& peak : shifts.peaks(part, wanted + 1)) {
    if (peak.correlation < alike || std::hypot(peak.x, peak.y) < 2 || repeats.size() == wanted)
      continue;
    repeats.push_back(best);
    for (std::size_t i = 0; i < 6; i += 2) {
      repeats.back()[i] += peak.x * pitch;
      repeats.back()[i + 1] += peak.y * pitch;
    }
  }
  return repeats;
}

}  // namespace surf
