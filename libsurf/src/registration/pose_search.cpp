// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/pose_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "registration/shift_search.h"
#include "surf/core/parallel.h"

namespace surf {
namespace {

constexpr double samples_across = 46;  // across a square of the SEM's area
// Root mean square displacement, in samples, halfway between two rotations.
constexpr double turn_miss = 1.0;
constexpr double scale_miss = 0.8;
constexpr std::size_t peaks_of_pose = 3;
// At the coarse blur, a map may overlap less than at the fine one.
constexpr double least_share_of_wanted = 0.85;
// Candidates closer than this, in samples, are the same.
constexpr double apart = 2.5;

struct Pose {
  double xx, xy, yx, yy;  // SEM to AFM
};

int steps_for(double range, double step) {
  return std::max(1, static_cast<int>(std::ceil(range / step)));
}

/// Scales in geometric progression, each in the middle of its part of the range.
std::vector<double> scales_between(double least, double largest, double reach) {
  const double range = std::log(largest / least);
  const int count = steps_for(range, 2 * scale_miss / reach);
  std::vector<double> scales;
  for (int i = 0; i < count; ++i) scales.push_back(least * std::exp(range * (i + 0.5) / count));
  return scales;
}

std::vector<Pose> poses_for(const BlurLevel& level, double pitch,
                            const RegistrationOptions& options) {
  // Root mean square distances from the centre, in samples.
  const double reach_x = std::max(1.0, 2 * level.sem.half_width() / std::sqrt(12.0) / pitch);
  const double reach_y = std::max(1.0, 2 * level.sem.half_height() / std::sqrt(12.0) / pitch);
  const int turns = steps_for(2 * std::numbers::pi, 2 * turn_miss / std::hypot(reach_x, reach_y));
  std::vector<Pose> poses;
  for (int t = 0; t < turns; ++t) {
    const double angle = 2 * std::numbers::pi * t / turns, c = std::cos(angle), s = std::sin(angle);
    for (const double sx : scales_between(options.least_scale, options.largest_scale, reach_x))
      for (const double sy : scales_between(options.least_scale, options.largest_scale, reach_y))
        poses.push_back({c * sx, -s * sy, s * sx, c * sy});
  }
  return poses;
}

/// The SEM's image, transformed to the AFM's frame except for the shift. It is sampled at a pitch
/// over its bounding rectangle, relative to its centre.
class Turned {
 public:
  Turned(const BlurLevel& level, const Pose& pose, double pitch)
      : level_(level), pose_(pose), pitch_(pitch) {
    const double w = level.sem.half_width(), h = level.sem.half_height();
    width_ = 1 + 2 * static_cast<int>((std::abs(pose.xx) * w + std::abs(pose.xy) * h) / pitch);
    height_ = 1 + 2 * static_cast<int>((std::abs(pose.yx) * w + std::abs(pose.yy) * h) / pitch);
  }

  std::pair<int, int> size() const { return {width_, height_}; }

  MaskedGrid samples() const {
    const double d = pose_.xx * pose_.yy - pose_.xy * pose_.yx;
    const auto back = [&](int i, int j) -> Point2 {
      const double x = (i - width_ / 2) * pitch_, y = (j - height_ / 2) * pitch_;
      return {(pose_.yy * x - pose_.xy * y) / d, (pose_.xx * y - pose_.yx * x) / d};
    };
    return sampled(
        width_, height_,
        [&](int i, int j) {
          const Point2 p = back(i, j);
          return level_.sem.value(p.x, p.y);
        },
        [&](int i, int j) {
          const Point2 p = back(i, j);
          return level_.sem.holds(p.x, p.y);
        });
  }

  /// The map that takes the centre to `x`, `y`.
  ThreePointMap three_points(double x, double y) const {
    const double w = level_.sem.half_width(), h = level_.sem.half_height();
    const auto at = [&](double px, double py) -> Point2 {
      return {x + pose_.xx * px + pose_.xy * py, y + pose_.yx * px + pose_.yy * py};
    };
    const Point2 a = at(-w, -h), b = at(w, -h), c = at(-w, h);
    return {a.x, a.y, b.x, b.y, c.x, c.y};
  }

 private:
  const BlurLevel& level_;
  Pose pose_;
  double pitch_;
  int width_, height_;
};

}  // namespace

double search_pitch_px(const PlacedImage& sem) {
  return std::max(1.0,
                  std::sqrt(double(sem.values.width()) * sem.values.height()) / samples_across);
}

PoseSearch search_poses(const BlurLevel& level, double pitch, const RegistrationOptions& options,
                        std::size_t wanted, const Watch& watch) {
  const std::vector<Pose> poses = poses_for(level, pitch, options);
  std::vector<std::pair<int, int>> sizes;
  for (const Pose& pose : poses) sizes.push_back(Turned(level, pose, pitch).size());
  const int columns = 1 + 2 * static_cast<int>(level.afm.half_width() / pitch);
  const int rows = 1 + 2 * static_cast<int>(level.afm.half_height() / pitch);
  const auto x_of = [&](double column) { return (column - columns / 2) * pitch; };
  const auto y_of = [&](double row) { return (row - rows / 2) * pitch; };
  const ShiftSearch shifts(
      sampled(
          columns, rows, [&](int i, int j) { return level.afm.value(x_of(i), y_of(j)); },
          [&](int i, int j) { return level.afm.holds(x_of(i), y_of(j)); }),
      least_share_of_wanted * options.least_overlap, sizes);

  std::vector<std::vector<PoseSearch::Candidate>> found(poses.size());
  parallel_for(
      poses.size(), resolve_threads(options.threads),
      [&](std::size_t p, int) {
        const Turned turned(level, poses[p], pitch);
        const auto [width, height] = turned.size();
        for (const ShiftPeak& peak : shifts.peaks(turned.samples(), peaks_of_pose))
          found[p].push_back(
              {turned.three_points(x_of(peak.x + width / 2), y_of(peak.y + height / 2)),
               peak.evidence});
      },
      watch);

  PoseSearch result;
  std::vector<PoseSearch::Candidate> all;
  for (const auto& of_pose : found) {
    result.best_of_pose.push_back(of_pose.empty() ? 0 : of_pose.front().evidence);
    all.insert(all.end(), of_pose.begin(), of_pose.end());
  }
  std::sort(result.best_of_pose.begin(), result.best_of_pose.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.evidence > b.evidence; });
  std::vector<std::size_t> everything(level.samples.size());
  for (std::size_t i = 0; i < everything.size(); ++i) everything[i] = i;
  const Moments moments = moments_of(level, everything);
  for (const PoseSearch::Candidate& candidate : all) {
    if (result.candidates.size() == wanted) break;
    const bool fresh =
        std::none_of(result.candidates.begin(), result.candidates.end(), [&](const auto& other) {
          return distance_px(candidate.corners, other.corners, moments) < apart * pitch;
        });
    if (fresh) result.candidates.push_back(candidate);
  }
  return result;
}

}  // namespace surf
