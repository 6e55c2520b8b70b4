// SPDX-License-Identifier: GPL-3.0-or-later
#include "what_held.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "surf/core/units.h"

namespace surf::workflow {
namespace {

constexpr double wall_deg = 30;
constexpr double least_share = 0.005;  // of the surface, of a part that is spoken of
constexpr double mainly = 0.8;         // of a part: it is held by that

struct Part {
  const char* name;
  std::array<double, 4> held{};  // samples by data support
  std::vector<double> deviations_nm;

  double samples() const { return held[0] + held[1] + held[2] + held[3]; }
};

/// 0: gentle. 1 to 4: walls that rise to the right, to the left, upward, downward.
std::size_t part_of(const HeightField& f, int x, int y) {
  const int w = f.z_nm.width(), h = f.z_nm.height();
  const int left = std::max(x - 1, 0), right = std::min(x + 1, w - 1), below = std::max(y - 1, 0),
            above = std::min(y + 1, h - 1);
  const double along = (f.z_nm(right, y) - f.z_nm(left, y)) / ((right - left) * f.pitch_x_nm),
               across = (f.z_nm(x, above) - f.z_nm(x, below)) / ((above - below) * f.pitch_y_nm);
  if (std::hypot(along, across) < std::tan(wall_deg * degrees_to_radians)) return 0;
  if (std::abs(along) >= std::abs(across)) return along > 0 ? 1 : 2;
  return across > 0 ? 3 : 4;
}

std::string in_words(Part& part, double of_surface) {
  constexpr const char* holders[] = {"through its neighbours", "by the AFM scan alone",
                                     "by the SEM image alone", "by both images"};
  std::array<std::size_t, 4> order{0, 1, 2, 3};
  std::ranges::sort(order, std::greater{}, [&](std::size_t k) { return part.held[k]; });
  std::string held;
  for (const std::size_t k : order) {
    const double share = part.held[k] / part.samples();
    if (share < 1 - mainly && k != order[0]) break;
    held += fmt::format("{}{} ({:.0f} %)", held.empty() ? "" : ", ", holders[k], 100 * share);
  }
  const auto middle =
      part.deviations_nm.begin() + static_cast<std::ptrdiff_t>(part.deviations_nm.size() / 2);
  std::nth_element(part.deviations_nm.begin(), middle, part.deviations_nm.end());
  return fmt::format("{}, {:.0f} % of the surface, held {}: within {} (median)", part.name,
                     100 * of_surface, held, format_length(*middle));
}

}  // namespace

std::vector<std::string> what_held(const Reconstruction& result) {
  if (result.data_support.empty() || result.deviation_nm.empty()) return {};
  std::array<Part, 5> parts{{{"gentle ground", {}, {}},
                             {"walls that rise to the right", {}, {}},
                             {"walls that rise to the left", {}, {}},
                             {"walls that rise upward", {}, {}},
                             {"walls that rise downward", {}, {}}}};
  const HeightField& f = result.surface;
  for (int y = 0; y < f.z_nm.height(); ++y)
    for (int x = 0; x < f.z_nm.width(); ++x) {
      Part& part = parts[part_of(f, x, y)];
      part.held[std::min<std::size_t>(result.data_support(x, y), 3)] += 1;
      part.deviations_nm.push_back(result.deviation_nm(x, y));
    }
  std::vector<std::string> sentences;
  const auto all = static_cast<double>(f.z_nm.size());
  for (Part& part : parts)
    if (part.samples() >= least_share * all)
      sentences.push_back(in_words(part, part.samples() / all));
  return sentences;
}

}  // namespace surf::workflow
