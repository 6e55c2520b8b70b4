// SPDX-License-Identifier: GPL-3.0-or-later
#include "place_doubt.h"

#include <algorithm>
#include <cmath>

namespace surf::workflow {
namespace {

constexpr double most_px = 100;
/// Of the image's longer side. What is small on a surface is as wrong at any place that is farther
/// off than it is large; the direction of a slide is known to a degree or so.
constexpr double slide = 0.1;

double square(double x) { return x * x; }

PlaceDoubt scaled(const PlaceDoubt& d, double factor) {
  return {factor * d.along_x, factor * d.along_y, factor * d.both};
}

void add(PlaceDoubt& sum, const PlaceDoubt& d) {
  sum.along_x += d.along_x;
  sum.along_y += d.along_y;
  sum.both += d.both;
}

/// The larger variance of any direction.
double largest(const PlaceDoubt& d) {
  return 0.5 * (d.along_x + d.along_y) + std::hypot(0.5 * (d.along_x - d.along_y), d.both);
}

/// The variances of the place of the SEM image's middle, as the registration knows them.
PlaceDoubt of_middle(const Pose& pose, const PlacedImage& sem) {
  const Point2 middle{sem.x_nm(sem.values.width() / 2), sem.y_nm(sem.values.height() / 2)};
  const double seen[3] = {middle.x, middle.y, 1};
  const auto in_scan = [&](int a, int b) {
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        sum += seen[i] * seen[j] *
               pose.registration->covariance[static_cast<std::size_t>(6 * (3 * a + i) + 3 * b + j)];
    return sum;
  };
  const double xx = in_scan(0, 0), xy = in_scan(0, 1), yy = in_scan(1, 1);
  const Affine back = inverse(pose.sem_to_afm);
  const auto in_pixels = [&](double ax, double ay, double bx, double by) {
    return ax * bx * xx + (ax * by + ay * bx) * xy + ay * by * yy;
  };
  const double x = 1 / sem.pitch_x_nm, y = 1 / sem.pitch_y_nm;
  return {in_pixels(back.xx * x, back.xy * x, back.xx * x, back.xy * x),
          in_pixels(back.yx * y, back.yy * y, back.yx * y, back.yy * y),
          in_pixels(back.xx * x, back.xy * x, back.yx * y, back.yy * y)};
}

double largest_slide(const PlacedImage& sem) {
  return square(std::min(most_px, slide * std::max(sem.values.width(), sem.values.height())));
}

/// The mean square of how far other places put the SEM image's middle from where it is: rivals, and
/// the registration's own place if a rival was preferred.
PlaceDoubt towards_rivals(const Pose& pose, const PlacedImage& sem) {
  const Point2 middle{sem.x_nm(sem.values.width() / 2), sem.y_nm(sem.values.height() / 2)};
  const Affine back = inverse(pose.sem_to_afm);
  PlaceDoubt sum;
  const auto include = [&](const Affine& other) {
    const Point2 there = back(other(middle));
    const double x = (there.x - middle.x) / sem.pitch_x_nm;
    const double y = (there.y - middle.y) / sem.pitch_y_nm;
    add(sum, {x * x, y * y, x * y});
  };
  include(pose.registration->sem_to_afm);
  for (const RegistrationRival& rival : pose.registration->rivals) include(rival.sem_to_afm);
  const PlaceDoubt mean = scaled(sum, 1 / static_cast<double>(pose.registration->rivals.size()));
  const double most = largest(mean);
  return most > 0 ? scaled(mean, std::min(1.0, largest_slide(sem) / most)) : mean;
}

PlaceDoubt along_the_slide(const Pose& pose, const PlacedImage& sem) {
  const PlaceDoubt known = of_middle(pose, sem);
  const double wanted = largest_slide(sem);
  const double most = largest(known);
  if (!std::isfinite(most) || !(most > 0)) return {wanted, wanted, 0};
  return scaled(known, wanted / most);
}

}  // namespace

PlaceDoubt place_doubt(const Pose& pose, const PlacedImage& sem) {
  PlaceDoubt doubt;
  if (pose.verified()) return doubt;
  if (!pose.preferred()) {
    const double stderr_px = pose.registration->stderr_px;
    doubt.along_x = doubt.along_y =
        square(std::isfinite(stderr_px) ? std::min(stderr_px, most_px) : most_px);
  }
  if (pose.registration->slides) add(doubt, along_the_slide(pose, sem));
  else if (!pose.every_rival_judged) add(doubt, towards_rivals(pose, sem));
  return doubt;
}

double largest_px(const PlaceDoubt& doubt) { return std::sqrt(largest(doubt)); }

}  // namespace surf::workflow
