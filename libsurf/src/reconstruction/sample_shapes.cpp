// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruction/sample_shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace surf {
namespace {

constexpr double degree = std::numbers::pi / 180;
// Beyond it a blurred edge is 0 relative to 1 in double precision.
constexpr double reach_in_blurs = 9;

Point2 unit(double angle) { return {std::cos(angle), std::sin(angle)}; }
double dot(Point2 a, Point2 b) { return a.x * b.x + a.y * b.y; }
double cross(Point2 a, Point2 b) { return a.x * b.y - a.y * b.x; }
Point2 minus(Point2 a, Point2 b) { return {a.x - b.x, a.y - b.y}; }
Point2 plus(Point2 a, Point2 b, double factor) { return {a.x + factor * b.x, a.y + factor * b.y}; }
double apart(Point2 a, Point2 b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// A blurred step that rises at x = 0.
double blurred_step(double x_nm, double blur_nm) {
  return 0.5 * std::erfc(-x_nm / (blur_nm * std::numbers::sqrt2));
}

/// A blurred strip of this half width about 0: even, and smooth also at 0.
double blurred_strip(double x_nm, double half_width_nm, double blur_nm) {
  if (std::abs(x_nm) > half_width_nm + reach_in_blurs * blur_nm) return 0;
  return blurred_step(half_width_nm - x_nm, blur_nm) - blurred_step(-half_width_nm - x_nm, blur_nm);
}

}  // namespace

Stroke::Stroke(Point2 start, double heading_deg, double width_nm, double blur_nm,
               const std::vector<StrokePiece>& pieces)
    : half_width_nm_(0.5 * width_nm), blur_nm_(blur_nm), start_(start),
      reach_nm_(half_width_nm_ + reach_in_blurs * blur_nm) {
  double heading = heading_deg * degree;
  for (const StrokePiece& step : pieces) {
    const double turn = step.turn_deg * degree;
    reach_nm_ += step.length_nm;
    Piece piece;
    piece.ends[0] = start;
    if (turn == 0) {
      piece.from = start;
      piece.along = unit(heading);
      piece.length_nm = step.length_nm;
      start = plus(start, piece.along, step.length_nm);
    } else {
      const double radius = step.length_nm / std::abs(turn), side = turn > 0 ? 1 : -1;
      piece.from = plus(start, unit(heading + side * std::numbers::pi / 2), radius);
      piece.along = unit(heading - side * std::numbers::pi / 2 + 0.5 * turn);
      piece.radius_nm = radius;
      piece.half_angle = 0.5 * std::abs(turn);
      heading += turn;
      start = plus(piece.from, unit(heading - side * std::numbers::pi / 2), radius);
    }
    piece.ends[1] = start;
    pieces_.push_back(piece);
  }
  if (pieces_.empty()) {
    Piece point;
    point.from = point.ends[0] = point.ends[1] = start;
    pieces_.push_back(point);
  }
}

double Stroke::distance(const Piece& piece, Point2 p) {
  const Point2 q = minus(p, piece.from);
  if (piece.radius_nm == 0) {
    const double t = std::clamp(dot(q, piece.along), 0.0, piece.length_nm);
    return apart(q, {t * piece.along.x, t * piece.along.y});
  }
  if (std::abs(std::atan2(cross(piece.along, q), dot(piece.along, q))) <= piece.half_angle)
    return std::abs(std::hypot(q.x, q.y) - piece.radius_nm);
  return std::min(apart(p, piece.ends[0]), apart(p, piece.ends[1]));
}

double Stroke::operator()(Point2 p) const {
  const Point2 q = minus(p, start_);
  if (dot(q, q) > reach_nm_ * reach_nm_) return 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Piece& piece : pieces_) nearest = std::min(nearest, distance(piece, p));
  return blurred_strip(nearest, half_width_nm_, blur_nm_);
}

Pad::Pad(Point2 centre, double width_nm, double depth_nm, double turn_deg, double blur_nm)
    : centre_(centre), along_(unit(turn_deg * degree)), half_width_nm_(0.5 * width_nm),
      half_depth_nm_(0.5 * depth_nm), blur_nm_(blur_nm) {}

double Pad::operator()(Point2 p) const {
  const Point2 q = minus(p, centre_);
  return blurred_strip(dot(q, along_), half_width_nm_, blur_nm_) *
         blurred_strip(cross(along_, q), half_depth_nm_, blur_nm_);
}

Island::Island(Point2 centre, double radius_nm, std::vector<double> amplitudes,
               std::vector<double> phases, double blur_nm)
    : centre_(centre), radius_nm_(radius_nm), amplitudes_(std::move(amplitudes)),
      phases_(std::move(phases)), blur_nm_(blur_nm) {}

double Island::operator()(Point2 p) const {
  const Point2 q = minus(p, centre_);
  const double reach_nm = 2 * radius_nm_ + reach_in_blurs * blur_nm_;
  if (dot(q, q) > reach_nm * reach_nm) return 0;
  const double r = std::hypot(q.x, q.y);
  const double angle = std::atan2(q.y, q.x);
  double share = 1, slope = 0;
  for (std::size_t i = 0; i < amplitudes_.size(); ++i) {
    const double k = static_cast<double>(i + 2);
    share += amplitudes_[i] * std::cos(k * angle + phases_[i]);
    slope -= k * amplitudes_[i] * std::sin(k * angle + phases_[i]);
  }
  // The argument is the distance to the outline, to first order.
  return blurred_step((radius_nm_ * share - r) / std::hypot(1, slope / share), blur_nm_);
}

}  // namespace surf
