// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/placed_image.h"
#include "surf/profile/feature_shape.h"

namespace surf {

/// A wall in an image, seen from above: an edge along y.
struct ImageEdge {
  int feature = 0;                ///< number of its line, trench, edge or hole, from the left
  bool material_right = true;     ///< the higher side is at larger x
  double place_nm = 0;            ///< x
  double from_nm = 0, to_nm = 0;  ///< the part of the image that is this edge's, along x
  double rim_nm = 0;              ///< x of its rim's brightest place, by the mean of all rows
};

/// The bright rim of a wall whose edge is not measured.
struct WallRim {
  bool material_right = true;  ///< see ImageEdge
  double place_nm = 0;         ///< x of its brightest place
};

/// Edges of an image by the threshold method: of each bright rim, where the flank on the ground's
/// side crosses this share of the way from the ground's level to the rim's.
struct ThresholdEdges {
  std::vector<ImageEdge> edges;                ///< from left to right, by the mean of all rows
  std::vector<std::vector<double>> places_nm;  ///< of each edge, by row; NaN where a row has none
  std::vector<double> rows_nm;                 ///< y of the rows
  /// Rims of walls that belong to no whole feature, because the image cuts it off.
  std::vector<WallRim> cut_off;
  /// Distance at which walls with the ground at one side repeat, features that the image cuts off
  /// included; 0: they do not.
  double pitch_nm = 0;
};

/// Finds the edges of lines, trenches or edges that run along y. Pairs of edges that the image cuts
/// off are left out. Throws InvalidInput if there are none, naming what was looked for.
ThresholdEdges find_edges(const PlacedImage& image, FeatureKind kind, double threshold = 0.5);

/// A round hole in an image.
struct Circle {
  double x_nm = 0, y_nm = 0, radius_nm = 0;
};
/// The hole whose bright rim surrounds the darkest part of the image. Throws InvalidInput if there
/// is none that lies in the image with its surroundings.
Circle find_hole(const PlacedImage& image);
/// From the hole's middle to the nearest end of the image, nm.
double room_about(const PlacedImage& image, const Circle& hole);

/// A cut through a hole's middle in the image of a tilted beam.
struct HoleCut {
  Circle hole;             ///< the radius is that of the specimen
  double azimuth_deg = 0;  ///< of the cut and of the beam's tilt, from x
  double shortening = 1;   ///< lengths along the cut in the image, over those of the specimen
};

/// The image about a point, unrolled: columns are distances from it, rows are directions, about as
/// far apart at the hole's rim as pixels are. x is the distance, y the length along the rim.
PlacedImage unrolled(const PlacedImage& image, const Circle& hole);

}  // namespace surf
