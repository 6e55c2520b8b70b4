// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Dense>
#include <array>
#include <utility>
#include <vector>

#include "simulation_errors.h"
#include "surf/profile/fit_profile.h"

namespace surf {

/// Numbers of walls with the ground at their left, and at their right.
using Walls = std::array<ProfileNumbers, 2>;

/// The numbers of a fit in one vector: the walls', those of the simulation's errors, then those of
/// each image, what shading is off by, then the walls' width, which is none of the fit's own: it
/// follows from the edges.
struct WallLayout {
  std::vector<std::size_t> free;  ///< numbers of a wall that are fitted
  int walls = 1;                  ///< 2: left and right walls have their own
  int width = 0;                  ///< place of the width in the vector
  int shading = -1;               ///< of what shading tells the height off by; -1: there is none
  double angle_by_shading = 0;    ///< degrees by nm: walls that are as wide as before

  int wall(int side) const { return (walls == 1 ? 0 : side) * static_cast<int>(free.size()); }
  int errors() const { return walls * static_cast<int>(free.size()); }
};

struct ProfileNormal {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd pull;  ///< minus the gradient
  double value = 0;      ///< the negative logarithm of the posterior
};

/// The equations without the last number, which follows from the others by these derivatives.
ProfileNormal followed(const ProfileNormal& all, const Eigen::VectorXd& last_by_others);

/// One image's part of a fit. Its own numbers follow each other in the fit's vector: gain, offset,
/// a displacement of each edge, the tilt. What the simulation is off by is of all images.
class SightOfWalls {
 public:
  /// Adds its looks at walls to the simulation's errors, which must outlive it. Throws InvalidInput
  /// for data without samples at an edge.
  SightOfWalls(const ProfileSight& sight, const ProfileFitOptions& options,
               SimulationErrors& errors);

  int numbers() const { return tilt() + 1; }
  int edge(int e) const { return 2 + e; }
  int edges() const { return static_cast<int>(sight_->data.edges.size()); }

  /// Gain, offset and the places of edges, by a search.
  void begin(const Walls& walls);
  /// Sets the variance of each pixel by what the fit says there. It stays until the next call, so
  /// that the objective is one function, whose gradient `add_to` adds.
  void weigh(const Walls& walls);
  /// Adds this image's part to the normal equations; its own numbers begin at `first`. Those that
  /// errors are taken from have slopes over some places.
  void add_to(const WallLayout& layout, int first, const Walls& walls, bool of_errors,
              ProfileNormal& out) const;
  /// What the libraries' own errors move the fit by, as columns, by the variances of `weigh`: all
  /// rows share them, and chance in neighbouring places looks like a slope that tells where an edge
  /// is.
  Eigen::MatrixXd pull_of_library(const WallLayout& layout, int first, const Walls& walls,
                                  int all) const;
  bool shows_shading_alone() const { return sight_->shows_shading_alone; }
  bool shares_library(const SightOfWalls& other) const {
    return sight_->left == other.sight_->left && sight_->right == other.sight_->right;
  }
  void move(const Eigen::VectorXd& step, int first);
  /// The place of each edge in each row, by its pixels alone, then as far as it stands out of the
  /// noise.
  void place_rows(const Walls& walls);
  void follow();
  /// A line of squared residuals against the level.
  void estimate_noise(const Walls& walls);

  std::vector<double> means() const;
  /// Pairs of edges of one feature.
  template <class Pair>
  void for_each_pair(const Pair& pair) const {
    const auto& edges = sight_->data.edges;
    for (std::size_t e = 0; e + 1 < edges.size(); ++e)
      if (edges[e].feature == edges[e + 1].feature) pair(e, e + 1);
  }
  /// Lengths along x in the image, over those of the specimen.
  double shortening() const { return shortening_; }
  const std::vector<std::vector<double>>& raw() const { return raw_; }
  const ProfileData& data() const { return sight_->data; }

  SightFit result(const Walls& walls, const Eigen::MatrixXd& covariance, int first) const;

 private:
  static constexpr int all_edges = -1;

  int tilt() const { return edge(edges()); }

  static int side_of(const ImageEdge& e) { return e.material_right ? 0 : 1; }
  static double sign_of(const ImageEdge& e) { return e.material_right ? 1 : -1; }
  const ImageEdge& edge_of(const ProfileSample& s) const {
    return sight_->data.edges[static_cast<std::size_t>(s.edge)];
  }
  const ProfileLibrary& library(int side) const {
    return side == 0 ? *sight_->left : *sight_->right;
  }
  double u_of(const ProfileSample& s) const;
  /// A wall's numbers as this image sees them: a tilt that is off looks like another angle, of the
  /// other sign on the other side.
  ProfileNumbers seen(const Walls& walls, int side) const;
  double tilted_by(int side) const { return side == 0 ? -toward_x_ : toward_x_; }

  double signal(const ProfileLibrary::Value& v) const { return v.value + 0.5 * blur2_ * v.by_u2; }
  /// What the simulation is off by at a place of a wall.
  double off_by(double u, int side) const {
    return simulation_->value(looks_[static_cast<std::size_t>(side)], u);
  }
  double model(const ProfileLibrary::Value& v, double u, int side) const;
  double variance_of(double level) const;
  /// All edges or one, away from their material.
  void move_outward(double by_nm, int edge = all_edges);
  /// Moves all edges or one to where residuals are least.
  void search(const Walls& walls, double farthest_nm, int edge = all_edges);
  /// Sets gain and offset by all pixels or those of an edge, and returns the mean squared residual.
  double scale(const Walls& walls, int edge = all_edges);
  /// The signal's slope over some places: that between two alone is half chance, which would look
  /// like something that tells where the edge is.
  double slope_around(double u, int side, const ProfileNumbers& numbers) const;

  /// Derivatives of the model at a sample, by number of the fit.
  using Derivatives = std::vector<std::pair<int, double>>;
  void derivatives(const WallLayout& layout, int first, const ProfileSample& s, double u,
                   const ProfileLibrary::Value& v, double slope, Derivatives& d) const;
  std::vector<MeanProfile> profiles(const Walls& walls) const;
  double unexplained(const std::vector<MeanProfile>& profiles) const;

  const ProfileSight* sight_;
  const ProfileFitOptions* options_;
  SimulationErrors* simulation_;
  std::array<int, 2> looks_{};            // at walls with the ground at their left, at their right
  double toward_x_ = 0, shortening_ = 1;  // cosine of the azimuth; see `shortening`
  double gain_ = 1, offset_ = 0, blur2_ = 0, contrast_ = 1, tilt_off_deg_ = 0;
  std::array<double, 2> noise_{};  // variance at level 0, and per level
  double least_variance_ = 0;
  std::vector<double> variances_;                           // of each sample
  std::vector<std::vector<double>> places_, raw_, errors_;  // of each edge, by row
};

}  // namespace surf
