// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/registration/landmarks.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <string>

#include "surf/core/error.h"

namespace surf {
namespace {

constexpr const char* subject = "landmarks";
// Relative to the spread of all points: smaller than people can click, and far above rounding
// errors.
constexpr double coincident = 1e-6, collinear = 1e-4;

using Points = Eigen::Matrix<double, Eigen::Dynamic, 2>;

Points points_of(const std::vector<LandmarkPair>& pairs, Point2 LandmarkPair::*side) {
  Points points(static_cast<Eigen::Index>(pairs.size()), 2);
  for (std::size_t i = 0; i < pairs.size(); ++i)
    points.row(static_cast<Eigen::Index>(i)) << (pairs[i].*side).x, (pairs[i].*side).y;
  return points;
}

std::string list_all(Eigen::Index count) {
  std::string list;
  for (Eigen::Index i = 1; i <= count; ++i)
    list += fmt::format("{}{}", i == 1 ? "" : i == count ? " and " : ", ", i);
  return list;
}

/// Points minus their mean, divided by their root mean square distance from it.
Points in_own_measure(const Points& points, const char* image) {
  const Eigen::RowVector2d mean = points.colwise().mean();
  Points centred = points.rowwise() - mean;
  const double spread = std::sqrt(centred.rowwise().squaredNorm().mean());
  // Differences of large numbers have few significant digits.
  if (!(spread > 1e-12 * (1 + mean.norm())))
    throw InvalidInput(
        subject,
        fmt::format("pairs {} lie at one place in the {} image", list_all(points.rows()), image),
        "Give three places or more that are apart");
  return centred / spread;
}

/// Throws an error that names the faulty pairs if the points do not span the plane.
void require_spread(const Points& points, const char* image) {
  const Points centred = in_own_measure(points, image);
  const Eigen::JacobiSVD<Points> svd(centred);
  const double thin = svd.singularValues()[1] / svd.singularValues()[0];
  if (thin > collinear) return;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    for (Eigen::Index j = i + 1; j < points.rows(); ++j)
      if ((centred.row(i) - centred.row(j)).norm() < coincident)
        throw InvalidInput(
            subject,
            fmt::format("pairs {} and {} lie at one place in the {} image, and the others do "
                        "not span the plane",
                        i + 1, j + 1, image),
            "Move one of them, or give more pairs");
  throw InvalidInput(
      subject,
      fmt::format("pairs {} all lie on a line in the {} image, which leaves the map across it "
                  "open",
                  list_all(points.rows()), image),
      "Give at least one pair away from that line");
}

}  // namespace

LandmarkFit fit_landmarks(const std::vector<LandmarkPair>& pairs) {
  for (std::size_t i = 0; i < pairs.size(); ++i)
    for (const double value :
         {pairs[i].sem_nm.x, pairs[i].sem_nm.y, pairs[i].afm_nm.x, pairs[i].afm_nm.y})
      if (!std::isfinite(value))
        throw InvalidInput(subject, fmt::format("pair {} is not finite", i + 1),
                           "Give finite coordinates");
  if (pairs.size() < 3)
    throw InvalidInput(
        subject,
        fmt::format("there {} {} pair{}, and an affine map needs three",
                    pairs.size() == 1 ? "is" : "are", pairs.size(), pairs.size() == 1 ? "" : "s"),
        "Give three pairs or more that do not lie on a line");
  const Points sem = points_of(pairs, &LandmarkPair::sem_nm),
               afm = points_of(pairs, &LandmarkPair::afm_nm);
  require_spread(sem, "SEM");
  require_spread(afm, "AFM");

  // Relative to the means, so that places far from the origin lose no digits.
  const Eigen::RowVector2d sem_mean = sem.colwise().mean(), afm_mean = afm.colwise().mean();
  const Eigen::Matrix2d linear =
      (sem.rowwise() - sem_mean).colPivHouseholderQr().solve(afm.rowwise() - afm_mean).transpose();
  const Eigen::Vector2d shift = afm_mean.transpose() - linear * sem_mean.transpose();
  LandmarkFit fit;
  fit.sem_to_afm = {linear(0, 0), linear(0, 1), shift[0], linear(1, 0), linear(1, 1), shift[1]};
  double sum = 0;
  for (Eigen::Index i = 0; i < sem.rows(); ++i) {
    const Eigen::RowVector2d miss =
        (sem.row(i) - sem_mean) * linear.transpose() - (afm.row(i) - afm_mean);
    fit.residuals_nm.push_back(miss.norm());
    sum += miss.squaredNorm();
  }
  fit.rms_nm = pairs.size() == 3 ? 0 : std::sqrt(sum / static_cast<double>(pairs.size()));
  return fit;
}

}  // namespace surf
