// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/overlap.h"

#include <algorithm>
#include <cmath>

namespace surf {

BlurLevel::BlurLevel(const PlacedImage& sem_image, const PlacedImage& afm_image,
                     const ThreePointFrame& frame, double blur)
    : blur_px(blur), stride(std::max(1, static_cast<int>(std::lround(blur)))),
      sem_step_x(sem_image.pitch_x_nm / frame.pixel_nm()),
      sem_step_y(sem_image.pitch_y_nm / frame.pixel_nm()),
      sem(sem_image, sem_step_x, sem_step_y, blur),
      afm(afm_image, afm_image.pitch_x_nm / frame.pixel_nm(),
          afm_image.pitch_y_nm / frame.pixel_nm(), blur) {
  // Small images keep enough samples to determine six numbers.
  const int w = sem_image.values.width(), h = sem_image.values.height();
  stride = std::clamp(std::min(w, h) / 12, 1, stride);
  for (int y = (h - 1) % stride / 2; y < h; y += stride)
    for (int x = (w - 1) % stride / 2; x < w; x += stride)
      if (sem.is_valid(x, y)) samples.push_back({frame.shares(x, y), sem.samples()(x, y), x, y});
}

std::vector<std::size_t> overlap_of(const BlurLevel& level, const ThreePointMap& corners) {
  std::vector<std::size_t> inside;
  for (std::size_t i = 0; i < level.samples.size(); ++i) {
    const Point2 p = place(corners, level.samples[i].shares);
    if (level.afm.holds(p.x, p.y)) inside.push_back(i);
  }
  return inside;
}

Moments moments_of(const BlurLevel& level, const std::vector<std::size_t>& overlap) {
  Moments m{};
  for (const std::size_t i : overlap)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k)
        m[j][k] += level.samples[i].shares[j] * level.samples[i].shares[k] /
                   static_cast<double>(overlap.size());
  return m;
}

double overlap_share(const BlurLevel& level, const ThreePointMap& c, std::size_t overlapping) {
  if (level.samples.empty()) return 0;
  const double of_sem =
      static_cast<double>(overlapping) / static_cast<double>(level.samples.size());
  const double sem_area = std::abs((c[2] - c[0]) * (c[5] - c[1]) - (c[3] - c[1]) * (c[4] - c[0]));
  const double afm_area = 4 * level.afm.half_width() * level.afm.half_height();
  return std::min(1.0, of_sem * std::max(1.0, sem_area / afm_area));
}

double Agreement::evidence() const {
  if (!(correlation > 0)) return 0;
  return -0.5 * static_cast<double>(samples) *
         std::log1p(-std::min(correlation * correlation, 1 - 1e-12));
}

Agreement agreement_of(const BlurLevel& level, const ThreePointMap& corners) {
  const std::vector<std::size_t> inside = overlap_of(level, corners);
  Agreement result{0, inside.size()};
  if (inside.size() < 2) return result;
  std::vector<double> values;
  values.reserve(inside.size());
  double mean_a = 0, mean_b = 0;
  for (const std::size_t i : inside) {
    const Point2 p = place(corners, level.samples[i].shares);
    values.push_back(level.afm.value(p.x, p.y));
    mean_a += level.samples[i].value;
    mean_b += values.back();
  }
  const auto n = static_cast<double>(inside.size());
  mean_a /= n;
  mean_b /= n;
  double aa = 0, bb = 0, ab = 0;
  for (std::size_t k = 0; k < inside.size(); ++k) {
    const double a = level.samples[inside[k]].value - mean_a, b = values[k] - mean_b;
    aa += a * a;
    bb += b * b;
    ab += a * b;
  }
  if (aa > 0 && bb > 0) result.correlation = std::clamp(ab / std::sqrt(aa * bb), -1.0, 1.0);
  return result;
}

}  // namespace surf
