// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "surf/core/vec3.h"
#include "surf/mesh/triangle_tree.h"

namespace surf::mc {

/// The surface within a ball, listed once for many questions about smaller balls in it. Triangles
/// that are small against what is asked stand as their corners, so that the cost hardly depends on
/// how finely a surface is meshed. Answers are conservative, as `NearestTriangle`'s. Positions are
/// about the ball's centre. Holds scratch space: one per thread.
class LocalTriangles {
 public:
  explicit LocalTriangles(const TriangleTree& tree) : tree_(tree) {}

  /// Lists what is within `radius` of `center`; triangles with no side longer than `small` stand as
  /// their corners (nm, >= 0).
  void collect(const Vec3& center, double radius, double small);

  /// What of the list matters for smaller balls. Valid until the next `collect`.
  struct Part;
  /// All of the list.
  const Part& all() const { return all_; }

  struct Nearest {
    double distance = HUGE_VAL;  ///< at most the true one
    Vec3 away;                   ///< out of the surface there, about; zero: not known
  };

  /// The surface nearest to `p`, of a part.
  Nearest nearest(const Part& part, const Vec3& p);

  /// What of a part is within `radius` of `p`, and a little more.
  void narrow(const Part& part, const Vec3& p, double radius, Part& out) const;

  /// Lists the triangles of a part within `radius` of `p`, for `slab` and `mean_normal` there.
  void look_at(const Part& part, const Vec3& p, double radius);

  /// All x of the surface that is looked at fulfil low <= n.(x - p) <= high, for a vector n no
  /// longer than 1; low > high: there is none.
  struct Slab {
    double low = HUGE_VAL;
    double high = -HUGE_VAL;
  };
  Slab slab(const Vec3& n);

  /// About the direction of the surface that is looked at; zero where there is nothing or walls
  /// face each other. Good for a guess only.
  Vec3 mean_normal() const;

 private:
  struct Face {
    Vec3 corners[3];
    Vec3 normal;   // zero: a needle
    double area2;  // twice the area
    Vec3 middle;
    double reach;  // of the corners from the middle
  };

 public:
  struct Part {
    std::vector<float> x, y, z;            // corners of small triangles, filled up to fours
    std::vector<float> nx, ny, nz;         // sums of the areas around them, as vectors
    std::vector<float> fx, fy, fz, reach;  // other triangles' spheres, filled up to fours
    std::vector<std::uint32_t> faces;      // which they are
  };

 private:
  void add_face(const Vec3 (&v)[3], const Vec3& across, double area2, double radius);
  static void fill_up(Part& part);
  template <class Visit>
  void visit_faces(const Part& part, const Vec3& p, const float& radius, const Visit& visit) const;
  double improve(const Face& face, const Vec3& p, Nearest& best) const;

  const TriangleTree& tree_;
  std::vector<std::uint32_t> triangles_;
  std::vector<Face> faces_;
  Part all_;
  double longest_ = 0;       // side of the small triangles
  double rounding_ = 0;      // of positions of their corners
  std::uint32_t guess_ = 0;  // a face that may be near
  // What is looked at.
  const Part* part_ = nullptr;
  Vec3 center_;
  double radius_ = 0;
  enum class Place : std::uint8_t { unknown, within, beyond };
  struct Candidate {
    std::uint32_t face;
    Place place;
  };
  std::vector<Candidate> candidates_;
  // Where a vertex is in the list, if it is in this one.
  struct Seen {
    std::uint32_t list = 0, at = 0;
  };
  std::vector<Seen> seen_;
  std::uint32_t lists_ = 0;
};

}  // namespace surf::mc
