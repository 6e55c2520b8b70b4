// SPDX-License-Identifier: GPL-3.0-or-later
#include "sky_view.h"

#include <algorithm>
#include <cmath>

#include "sem/model/border.h"

namespace surf::network {
namespace {

constexpr int directions = 16;
constexpr int most_steps = 2;  // per direction and band

/// The directions of one quadrant; rotations by 90 degrees give the others.
struct Step {
  int dx, dy;
};
constexpr Step quarter[] = {{1, 0}, {2, 1}, {1, 1}, {1, 2}};

std::vector<int> steps_within(double from_nm, double to_nm, double step_nm) {
  const int first = static_cast<int>(std::floor(from_nm / step_nm * (1 + 1e-12))) + 1;
  const int last = static_cast<int>(std::floor(to_nm / step_nm * (1 + 1e-12)));
  if (last < first) return {std::max(1, static_cast<int>(std::lround(to_nm / step_nm)))};
  if (last - first + 1 <= most_steps) {
    std::vector<int> all;
    for (int k = first; k <= last; ++k) all.push_back(k);
    return all;
  }
  // At 0.25 and 0.8 of the band on a logarithmic scale (from the first step if the band begins at
  // 0).
  const double low = std::max<double>(first, from_nm / step_nm), ratio = last / low;
  const int near =
      std::clamp(static_cast<int>(std::lround(low * std::pow(ratio, 0.25))), first, last - 1);
  const int far =
      std::clamp(static_cast<int>(std::lround(low * std::pow(ratio, 0.8))), near + 1, last);
  return {near, far};
}

}  // namespace

SkyView::SkyView(const std::vector<double>& edges_nm, double pitch_nm)
    : bands_(edges_nm.empty() ? 0 : static_cast<int>(edges_nm.size()) - 1) {
  if (bands_ == 0) return;
  for (int d = 0; d < directions; ++d) {
    Step step = quarter[d % 4];
    for (int turns = d / 4; turns > 0; --turns) step = {-step.dy, step.dx};
    const double step_nm = std::hypot(step.dx, step.dy) * pitch_nm;
    for (int band = 0; band < bands_; ++band) {
      const std::vector<int> steps = steps_within(edges_nm[band], edges_nm[band + 1], step_nm);
      for (const int k : steps)
        samples_.push_back({k * step.dx, k * step.dy, band, k * step_nm,
                            1.0 / (directions * static_cast<double>(steps.size())), false});
    }
    samples_.back().last = true;
  }
  for (const Sample& s : samples_) reach_ = std::max({reach_, std::abs(s.dx), std::abs(s.dy)});
}

template <class T>
SkyPlane<T>::SkyPlane(const Grid<double>& z_nm, double level, double unit, Edge edge, int around,
                      int columns)
    : reach(around) {
  const int width = z_nm.width(), height = z_nm.height();
  const int whole = (width + columns - 1) / columns * columns;  // only whole strips are computed
  stride = whole + 2 * std::ptrdiff_t{reach};
  values.resize(static_cast<std::size_t>(stride * (height + 2 * reach)));
  for (int y = -reach; y < height + reach; ++y) {
    const int row = border_sample(y, height, edge);
    T* const out = values.data() + (y + reach) * stride;
    for (int x = 0; x < stride; ++x)
      out[x] = T((z_nm(border_sample(x - reach, width, edge), row) - level) / unit);
  }
}

template <class T>
std::vector<SkySample<T>> in_plane(const SkyView& view, std::ptrdiff_t stride) {
  std::vector<SkySample<T>> samples;
  for (const SkyView::Sample& s : view.samples()) {
    if (!samples.empty() && samples.back().band != s.band) samples.back().ends_band = true;
    const double steps = std::hypot(s.dx, s.dy);
    samples.push_back({s.dy * stride + s.dx, T(s.distance_nm * s.distance_nm), T(s.weight),
                       T(s.dx / steps), T(s.dy / steps), s.band, s.last, s.last});
  }
  return samples;
}

template struct SkyPlane<float>;
template struct SkyPlane<double>;
template std::vector<SkySample<float>> in_plane(const SkyView&, std::ptrdiff_t);
template std::vector<SkySample<double>> in_plane(const SkyView&, std::ptrdiff_t);

}  // namespace surf::network
