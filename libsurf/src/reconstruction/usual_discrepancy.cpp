// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "gaussian_basis.h"
#include "surf/core/error.h"
#include "surf/reconstruction/reconstruct.h"

namespace surf {
namespace {

using namespace reconstruction;

constexpr double soft_px = 1.5;          // electrons' noise is not contrast
constexpr double usual_contrast = 0.15;  // of the image's, where nothing stands out
constexpr double fine_px = 4, wide_px = 48;
constexpr double share_of_drift = 0.5;

std::optional<double> median_of(const PlacedImage& image) {
  std::vector<double> levels;
  for (int y = 0; y < image.values.height(); ++y)
    for (int x = 0; x < image.values.width(); ++x)
      if (image.is_valid(x, y)) levels.push_back(image.values(x, y));
  if (levels.empty()) return std::nullopt;
  const auto middle = levels.begin() + static_cast<std::ptrdiff_t>(levels.size() / 2);
  std::nth_element(levels.begin(), middle, levels.end());
  return *middle;
}

Grid<double> without_holes(const PlacedImage& image, double filling) {
  Grid<double> known = image.values;
  for (int y = 0; y < known.height(); ++y)
    for (int x = 0; x < known.width(); ++x)
      if (!image.is_valid(x, y)) known(x, y) = filling;
  return known;
}

}  // namespace

double contrast_of(const PlacedImage& image) {
  validate(image, "SEM image");
  const auto median = median_of(image);
  if (!median) return 0;
  const Grid<double> soft = GaussianBasis(soft_px, 1).sum(without_holes(image, *median));
  double sum = 0, squares = 0, n = 0;
  for (int y = 0; y < soft.height(); ++y)
    for (int x = 0; x < soft.width(); ++x)
      if (image.is_valid(x, y)) sum += soft(x, y), squares += soft(x, y) * soft(x, y), n += 1;
  return std::sqrt(std::max(0.0, squares / n - sum / n * (sum / n)));
}

std::vector<SemDiscrepancy> usual_discrepancy(const PlacedImage& image, double share) {
  validate(image, "SEM image");
  if (!(share >= 0 && share <= 1))
    throw InvalidInput("model error", "it is not a share from 0 to 1", "0.05 is usual");
  if (share == 0) return {};
  const auto median = median_of(image);
  if (!median) return {};
  const GaussianBasis soft(soft_px, 1);
  Grid<double> contrast = soft.sum(without_holes(image, *median));
  for (double& c : contrast.data()) c = std::abs(c - *median);
  Grid<double> squares = contrast;
  double mean = 0;
  for (double& c : squares.data()) c *= c, mean += c / static_cast<double>(squares.size());
  squares = soft.sum(squares);
  SemDiscrepancy fine{squares, fine_px}, wide{squares, wide_px};
  for (std::size_t i = 0; i < squares.size(); ++i) {
    fine.deviation.data()[i] =
        share * std::sqrt(squares.data()[i] + usual_contrast * usual_contrast * mean);
    wide.deviation.data()[i] = share * share_of_drift * (contrast.data()[i] + std::sqrt(mean));
  }
  return {std::move(fine), std::move(wide)};
}

Grid<double> line_jitter(const PlacedImage& image, double deviation_px) {
  validate(image, "SEM image");
  if (!(deviation_px >= 0 && deviation_px <= 5))
    throw InvalidInput("jitter of lines", "it is not from 0 to 5 pixels", "0.3 pixels are usual");
  const Grid<double> soft = GaussianBasis(soft_px, 1).sum(image.values);
  Grid<double> out(soft.width(), soft.height());
  for (int y = 0; y < out.height(); ++y)
    for (int x = 1; x + 1 < out.width(); ++x)
      if (image.is_valid(x, y)) out(x, y) = -0.5 * deviation_px * (soft(x + 1, y) - soft(x - 1, y));
  return out;
}

}  // namespace surf
