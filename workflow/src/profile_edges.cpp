// SPDX-License-Identifier: GPL-3.0-or-later
#include "profile_edges.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace surf::workflow {
namespace {

constexpr double least_error_px = 0.1;
constexpr double hidden_px = 3;  // rims that lie nearer to the image's end may not be found

double inward(bool material_right) { return material_right ? 1 : -1; }

/// What edges of walls that face one side are like.
struct UsualEdge {
  double to_rim_nm = 0;  ///< from the edge to its rim, into the material
  double to_rim_error_nm = 0;
  double rough_nm = 0;  ///< root mean square of rows about the edge's mean
};

/// By the fitted edges that face this side, or by all if there are none.
UsualEdge usual_edge(const std::vector<FittedEdge>& fitted, bool material_right, double pixel_nm) {
  const bool has_like = std::ranges::any_of(
      fitted, [&](const FittedEdge& e) { return e.edge.material_right == material_right; });
  double n = 0, mean = 0, squares = 0, rough = 0, error = 0;
  for (const FittedEdge& f : fitted) {
    if (has_like && f.edge.material_right != material_right) continue;
    const double to_rim = inward(f.edge.material_right) * (f.edge.rim_nm - f.place_nm.value);
    ++n, mean += to_rim, squares += to_rim * to_rim, error += f.place_nm.standard_error;
    for (const double x : f.smooth_nm)
      rough += std::pow(x - f.place_nm.value, 2) / static_cast<double>(f.smooth_nm.size());
  }
  mean /= n, error /= n;
  const double scatter = n > 1 ? std::max(0.0, squares / n - mean * mean) * n / (n - 1) : 0,
               floor = least_error_px * pixel_nm;
  return {mean, std::sqrt(scatter + floor * floor + error * error), std::sqrt(rough / n)};
}

FittedEdge straight_edge(bool material_right, Measured place_nm, double rough_nm,
                         std::size_t rows) {
  FittedEdge edge;
  edge.edge.material_right = material_right;
  edge.place_nm = place_nm;
  edge.smooth_nm = edge.rows_nm = std::vector<double>(rows, place_nm.value);
  edge.errors_nm = std::vector<double>(rows, rough_nm);
  return edge;
}

/// The edge after the last one to one side (1: to larger x), a pitch from the last that faces as it
/// does.
std::optional<FittedEdge> next_edge(const PlacedImage& image, const std::vector<FittedEdge>& edges,
                                    const std::vector<FittedEdge>& fitted, Measured pitch_nm,
                                    int side) {
  const auto along = [&](const FittedEdge& e) { return side * e.place_nm.value; };
  const FittedEdge& last = *std::ranges::max_element(edges, {}, along);
  const FittedEdge* like = nullptr;
  for (const FittedEdge& e : edges)
    if (e.edge.material_right != last.edge.material_right && (!like || along(e) > along(*like)))
      like = &e;
  if (!like) return std::nullopt;
  const double place = like->place_nm.value + side * pitch_nm.value, pixel = image.pitch_x_nm,
               end = image.x_nm(side > 0 ? image.values.width() - 1 : 0);
  if (side * place <= along(last)) return std::nullopt;
  const bool right = like->edge.material_right;
  const UsualEdge usual = usual_edge(fitted, right, pixel);
  if (side * (end - place - inward(right) * usual.to_rim_nm) > hidden_px * pixel)
    return std::nullopt;                                             // it would have been seen
  if (side * (place - end) >= usual.to_rim_nm) return std::nullopt;  // no part of it is in sight
  return straight_edge(right,
                       {place, std::hypot(like->place_nm.standard_error, pitch_nm.standard_error)},
                       usual.rough_nm, last.smooth_nm.size());
}

}  // namespace

std::vector<FittedEdge> edges_in_sight(const PlacedImage& image,
                                       const std::vector<WallRim>& cut_off,
                                       const std::vector<FittedEdge>& fitted, Measured pitch_nm) {
  std::vector<FittedEdge> out = fitted;
  for (const WallRim& rim : cut_off) {
    const UsualEdge usual = usual_edge(fitted, rim.material_right, image.pitch_x_nm);
    out.push_back(straight_edge(
        rim.material_right,
        {rim.place_nm - inward(rim.material_right) * usual.to_rim_nm, usual.to_rim_error_nm},
        usual.rough_nm, fitted.front().smooth_nm.size()));
  }
  if (pitch_nm.value > 0) {
    const std::vector<FittedEdge> seen = out;
    for (const int side : {-1, 1})
      if (auto edge = next_edge(image, seen, fitted, pitch_nm, side))
        out.push_back(std::move(*edge));
  }
  return out;
}

}  // namespace surf::workflow
