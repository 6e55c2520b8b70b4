// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "surf/refinement/fit_modes.h"

namespace surf {
namespace {

std::vector<double> gaussian(double sigma) {
  const int reach = static_cast<int>(std::ceil(3 * sigma));
  std::vector<double> out;
  double sum = 0;
  for (int k = -reach; k <= reach; ++k)
    out.push_back(std::exp(-0.5 * k * k / (sigma * sigma))), sum += out.back();
  for (double& w : out) w /= sum;
  return out;
}

/// Beyond its border an image goes on as its outermost pixels.
Grid<double> filtered(const Grid<double>& in, const std::vector<double>& kernel, bool along_x) {
  const int reach = static_cast<int>(kernel.size() / 2), w = in.width(), h = in.height();
  Grid<double> out(w, h);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      for (int k = -reach; k <= reach; ++k)
        out(x, y) += kernel[static_cast<std::size_t>(k + reach)] *
                     in(along_x ? std::clamp(x + k, 0, w - 1) : x,
                        along_x ? y : std::clamp(y + k, 0, h - 1));
  return out;
}

}  // namespace

RefinedView blurred(const RefinedView& view, double sigma_px) {
  RefinedView out = view;
  if (!(sigma_px > 0)) return out;
  const std::vector<double> kernel = gaussian(sigma_px);
  const auto blur = [&](Grid<double>& grid) {
    grid = filtered(filtered(grid, kernel, true), kernel, false);
  };
  // Pixels without a signal take what is simulated there.
  for (std::size_t p = 0; p < out.measured.size(); ++p)
    if (!view.used.includes(p)) out.measured.data()[p] = view.simulated.data()[p];
  blur(out.measured), blur(out.simulated);
  if (!out.first_half.empty()) blur(out.first_half), blur(out.second_half);
  const auto blur_effect = [&](ModeEffect& e) {
    if (e.pixels.empty()) return;
    for (std::vector<double>* values : {&e.first, &e.second}) {
      Grid<double> grid(view.measured.width(), view.measured.height());
      grid.data() = *values;
      blur(grid);
      *values = grid.data();
    }
  };
  for (ModeEffect& e : out.effects) blur_effect(e);
  blur_effect(out.tilt_x), blur_effect(out.tilt_y);
  return out;
}

}  // namespace surf
