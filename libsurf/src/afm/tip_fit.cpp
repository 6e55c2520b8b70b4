// SPDX-License-Identifier: GPL-3.0-or-later
#include "tip_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "surf/afm/height_range.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "afm/tip_fit.cpp"
#include "core/each_target.h"

HWY_BEFORE_NAMESPACE();
namespace surf::HWY_NAMESPACE {

// Where surface + offset exceeds the dilation `made`, `sample` becomes the contact, and the former
// dilation becomes `next`.
void raise(float* __restrict made, float* __restrict next, std::int32_t* __restrict touching,
           std::int32_t* __restrict next_touching, const float* __restrict surface, float offset,
           std::int32_t sample, int count) {
  for (int x = 0; x < count; ++x) {
    const float v = surface[x] + offset;
    const bool first = v > made[x], second = !first && v > next[x];
    next[x] = first ? made[x] : second ? v : next[x];
    next_touching[x] = first ? touching[x] : second ? sample : next_touching[x];
    made[x] = first ? v : made[x];
    touching[x] = first ? sample : touching[x];
  }
}

}  // namespace surf::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace surf {

namespace {

HWY_EXPORT(raise);

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr double cost = 2;           // cost of a free pixel, in units of the misfit (Stein, Akaike)
constexpr int between_contacts = 4;  // steps with the same contacts
constexpr int between_thinning = 16;  // pixels that are removed too early leave the tip blunt
// Share of the way to the mean that the pixels in contact would have.
constexpr double step = 0.5;

}  // namespace

TipFit::TipFit(const std::vector<HeightField>& scans, const AfmNoise& noise, const Tip& start)
    : noise_(noise), tip_(start),
      left_(std::max(start.apex_x, start.z_nm.width() - 1 - start.apex_x)),
      below_(std::max(start.apex_y, start.z_nm.height() - 1 - start.apex_y)) {
  const HeightRange range = height_range(scans);
  for (int j = 0; j < tip_.z_nm.height(); ++j)
    for (int i = 0; i < tip_.z_nm.width(); ++i)
      if (tip_.z_nm(i, j) > -range.span_nm()) samples_.push_back({i, j});
  for (const HeightField& s : scans) {
    Frame f;
    f.width = s.z_nm.width();
    f.height = s.z_nm.height();
    f.row = (f.width + 15) / 16 * 16;
    f.stride = f.row + 2 * left_;
    const auto area = static_cast<std::size_t>(f.row) * static_cast<std::size_t>(f.height);
    f.scan.assign(area, std::numeric_limits<float>::quiet_NaN());
    f.made.resize(area);
    f.next.resize(area);
    f.touching.resize(area);
    f.next_touching.resize(area);
    f.surface.assign(
        static_cast<std::size_t>(f.stride) * static_cast<std::size_t>(f.height + 2 * below_),
        infinity);
    for (int y = 0; y < f.height; ++y)
      for (int x = 0; x < f.width; ++x) {
        const auto k = static_cast<std::size_t>(y * f.row + x);
        f.scan[k] = s.is_valid(x, y) ? static_cast<float>(s.z_nm(x, y) - range.low_nm)
                                     : std::numeric_limits<float>::quiet_NaN();
        if (!s.is_valid(x, y)) continue;
        pixels_ += 1;
        for (const Sample& u : samples_) {
          float& z = f.surface[static_cast<std::size_t>(surface_at(f, x, y, u))];
          z = std::min(z, f.scan[k] - static_cast<float>(tip_.z_nm(u.i, u.j)));
        }
      }
    for (float& z : f.surface)
      if (z == infinity) z = -infinity;
    frames_.push_back(std::move(f));
  }
}

void TipFit::dilate(Frame& f) const {
  std::fill(f.made.begin(), f.made.end(), -infinity);
  std::fill(f.next.begin(), f.next.end(), -infinity);
  std::fill(f.touching.begin(), f.touching.end(), -1);
  std::fill(f.next_touching.begin(), f.next_touching.end(), -1);
  for (int y = 0; y < f.height; ++y) {
    const auto row = static_cast<std::size_t>(y * f.row);
    for (std::size_t s = 0; s < samples_.size(); ++s) HWY_DYNAMIC_DISPATCH(raise)
    (&f.made[row], &f.next[row], &f.touching[row], &f.next_touching[row],
     &f.surface[static_cast<std::size_t>(surface_at(f, 0, y, samples_[s]))],
     static_cast<float>(tip_.z_nm(samples_[s].i, samples_[s].j)), static_cast<std::int32_t>(s),
     f.row);
  }
}

// Removes surface pixels that reduce the misfit by less than they cost in freedom.
void TipFit::thin(Frame& f) const {
  const double of_v = (1 + noise_.alpha * noise_.alpha) / noise_.innovation_nm2;
  std::vector<float> gain(f.surface.size(), 0);
  std::vector<std::uint8_t> needed(f.surface.size(),
                                   0);  // bits: 1 must stay, 2 replaces a removed pixel, 4 removed
  const auto at = [&](int x, int y, std::int32_t sample) {
    return static_cast<std::size_t>(
        surface_at(f, x, y, samples_[static_cast<std::size_t>(sample)]));
  };
  const auto each_pixel = [&](const auto& look) {
    for (int y = 0; y < f.height; ++y)
      for (int x = 0; x < f.width; ++x) {
        const auto k = static_cast<std::size_t>(y * f.row + x);
        if (std::isfinite(f.scan[k]) && f.touching[k] >= 0) look(x, y, k);
      }
  };
  each_pixel([&](int x, int y, std::size_t k) {
    const double now = f.made[k] - f.scan[k], then = f.next[k] - f.scan[k];
    gain[at(x, y, f.touching[k])] += static_cast<float>(of_v * (then * then - now * now));
  });
  // One pixel after the other. A pixel that replaces a removed one must stay.
  each_pixel([&](int x, int y, std::size_t k) {
    const std::size_t own = at(x, y, f.touching[k]);
    if (gain[own] >= cost || f.next_touching[k] < 0) needed[own] |= 1;
  });
  each_pixel([&](int x, int y, std::size_t k) {
    const std::size_t own = at(x, y, f.touching[k]);
    if (needed[own] & 1) return;
    const std::size_t other = at(x, y, f.next_touching[k]);
    if (needed[own] & 2) return;  // it replaces another pixel
    if (needed[other] & 4) {      // its replacement is removed
      needed[own] |= 1;
      return;
    }
    needed[own] |= 4;
    needed[other] |= 2;
  });
  for (std::size_t k = 0; k < f.surface.size(); ++k)
    if (needed[k] == 4) f.surface[k] = -infinity;
  each_pixel([&](int x, int y, std::size_t k) {
    if (needed[at(x, y, f.touching[k])] != 4) return;
    f.made[k] = f.next[k];
    f.touching[k] = f.next_touching[k];
  });
}

// Updates the dilation at unchanged contacts.
void TipFit::follow(Frame& f) const {
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x) {
      const auto k = static_cast<std::size_t>(y * f.row + x);
      if (f.touching[k] < 0) continue;
      const Sample& u = samples_[static_cast<std::size_t>(f.touching[k])];
      f.made[k] = f.surface[static_cast<std::size_t>(surface_at(f, x, y, u))] +
                  static_cast<float>(tip_.z_nm(u.i, u.j));
    }
}

// Moves the surface, and adds to the tip's slope, to the contacts, and to misfit and freedom.
void TipFit::pull(Frame& f, std::vector<double>& slope) {
  Grid<double> residual(f.width, f.height), gradient;
  Mask valid(f.width, f.height, 1);
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x) {
      const auto k = static_cast<std::size_t>(y * f.row + x);
      valid(x, y) = std::isfinite(f.scan[k]) && f.touching[k] >= 0;
      residual(x, y) = valid(x, y) ? f.made[k] - f.scan[k] : 0;
    }
  log_likelihood(residual, noise_, valid, &gradient);  // the derivative is -R^-1 e
  for (std::size_t k = 0; k < residual.size(); ++k)
    misfit_ -= residual.data()[k] * gradient.data()[k];
  surface_slope_.assign(f.surface.size(), 0);
  surface_weight_.assign(f.surface.size(), 0);
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x) {
      if (!valid(x, y)) continue;
      const auto s = static_cast<std::size_t>(f.touching[static_cast<std::size_t>(y * f.row + x)]);
      const auto at = static_cast<std::size_t>(surface_at(f, x, y, samples_[s]));
      surface_slope_[at] -= gradient(x, y);
      surface_weight_[at] += 1;
      slope[s] -= gradient(x, y);
      ++contacts_[s];
    }
  const double curvature = (1 + noise_.alpha * noise_.alpha) / noise_.innovation_nm2;
  for (std::size_t k = 0; k < f.surface.size(); ++k)
    if (surface_weight_[k] > 0) {
      f.surface[k] -=
          static_cast<float>(step * surface_slope_[k] / (curvature * surface_weight_[k]));
      freedom_ += 1;
    }
}

void TipFit::iterate(int times) {
  const double sigma = std::sqrt(noise_.variance_nm2());
  const double curvature = (1 + noise_.alpha * noise_.alpha) / noise_.innovation_nm2;
  std::vector<double> slope(samples_.size());
  for (int n = 0; n <= times; ++n) {  // the last round only evaluates
    std::fill(slope.begin(), slope.end(), 0.0);
    contacts_.assign(samples_.size(), 0);
    misfit_ = freedom_ = 0;
    for (Frame& f : frames_) {
      if (n % between_contacts == 0 || n == times) dilate(f);
      else follow(f);
      if (n % between_thinning == between_thinning - 1 && n < times) thin(f);
      pull(f, slope);
    }
    misfit_ /= pixels_;
    freedom_ /= pixels_;
    if (n == times) break;
    for (std::size_t s = 0; s < samples_.size(); ++s) {
      double& z = tip_.z_nm(samples_[s].i, samples_[s].j);
      const double weight =
          curvature * static_cast<double>(std::max<std::int64_t>(contacts_[s], 1));
      z = std::min(0.0, z - std::clamp(step * (slope[s] - 1 / sigma) / weight, -sigma, sigma));
    }
    tip_.z_nm(tip_.apex_x, tip_.apex_y) = 0;
  }
}

double TipFit::risk_when_thinned() const {
  constexpr int settling = 4;
  TipFit copy = *this;
  for (Frame& f : copy.frames_) copy.thin(f);
  copy.iterate(settling);
  return copy.risk();
}

Grid<double> TipFit::standard_errors() const {
  // A pixel in contact measures the sum of surface and tip there. There are so many free surface
  // pixels that each has the variance of the noise, which makes two variances per contact.
  Grid<double> out(tip_.z_nm.width(), tip_.z_nm.height(), std::numeric_limits<double>::infinity());
  for (std::size_t s = 0; s < samples_.size(); ++s)
    if (contacts_[s] > 0)
      out(samples_[s].i, samples_[s].j) =
          std::sqrt(2 * noise_.variance_nm2() / static_cast<double>(contacts_[s]));
  out(tip_.apex_x, tip_.apex_y) = 0;
  return out;
}

}  // namespace surf
#endif
