// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstdint>

#include "cascades/cascade_format.h"
#include "geometry/rotation.h"

namespace surf::mc {

/// x, y, z of a packed vertex or sphere.
inline Float4 coordinates(std::uint64_t word) {
  using Short4 = std::int16_t __attribute__((vector_size(8)));
  return __builtin_convertvector(std::bit_cast<Short4>(word), Float4);
}

/// A plane in the frame that branches lie in.
struct FramedPlane {
  Float4 point{}, normal{};  ///< `normal` has unit length

  float along(const Float4& v) const {
    return normal[0] * v[0] + normal[1] * v[1] + normal[2] * v[2];
  }
  Float4 mirrored(const Float4& v) const { return v - normal * (2 * along(v)); }
};

/// How a branch of a stored cascade lies in a frame: its first point, and a rotation from the
/// branch's coordinates. A surface changes the rest of a branch as a rigid motion does, so a pose
/// is all that has to be kept. Lengths are nm in the frame.
struct BranchPose {
  Float4 origin{};      ///< the branch's first point
  Rotation scaled;      ///< from the branch's coordinates
  Float4 over_plane{};  ///< heights over the flat surroundings' plane: of the coordinates, and of
                        ///< the origin
  Float4 over_frame{};  ///< heights along the frame's z, likewise
  int exponent = 0;     ///< of the branch's unit
  int changes = 0;      ///< of the pose
  int moves = 0;        ///< changes other than mirrors in that plane
  bool left_ball = false;  ///< it came otherwise than through matter from the ball's centre
  bool deflected = false;  ///< by a surface, since it last forgot its direction

  /// Changes the unit, not the pose.
  void scale(int to) {
    if (to == exponent) return;
    const float ratio = power_of_two(to - exponent);
    exponent = to;
    scaled = scaled * ratio;
    over_plane = over_plane * Float4{ratio, ratio, ratio, 1};
    over_frame = over_frame * Float4{ratio, ratio, ratio, 1};
  }

  Float4 point(std::uint64_t word) const {
    const Float4 v = coordinates(word);
    return origin + scaled.x * v[0] + scaled.y * v[1] + scaled.z * v[2];
  }
  float height_over_plane(std::uint64_t word) const { return height(word, over_plane); }
  float height_over_frame(std::uint64_t word) const { return height(word, over_frame); }
  float radius(std::uint64_t sphere) const {
    return static_cast<float>(sphere >> 48) * power_of_two(exponent);
  }

  /// After any change of `origin` or `scaled`.
  void note_change() {
    over_frame = Float4{scaled.x[2], scaled.y[2], scaled.z[2], origin[2]};
    ++changes;
  }

  /// From now on heights over this plane can be asked for.
  void measure_from(const FramedPlane& plane) {
    over_plane = Float4{plane.along(scaled.x), plane.along(scaled.y), plane.along(scaled.z),
                        plane.along(origin - plane.point)};
  }

  /// The pose of a branch that begins at this vertex of this one.
  BranchPose child_at(std::uint64_t vertex) const {
    BranchPose child = *this;
    child.origin = point(vertex);
    child.over_plane[3] = height_over_plane(vertex);
    child.over_frame[3] = child.origin[2];
    return child;
  }

  /// A mirror in the plane that heights are measured from.
  void mirror_in(const FramedPlane& plane) {
    scaled = {plane.mirrored(scaled.x), plane.mirrored(scaled.y), plane.mirrored(scaled.z)};
    origin = plane.point + plane.mirrored(origin - plane.point);
    over_plane = -over_plane;
    deflected = true;
    note_change();
  }

  /// The rest goes on from `to`, where it would have from `from`, turned by `motion`.
  void move(const Rotation& motion, const Float4& from, const Float4& to) {
    origin = to + motion(origin - from);
    scaled = motion * scaled;
    ++moves;
    deflected = true;
    note_change();
  }

  /// Where an electron is scattered into all directions alike, the rest of its branch may lie as it
  /// likes. It lies as `home`, the cascade as it entered, so that a surface that is a little higher
  /// or lower moves it a little, where a mirror would send it elsewhere.
  void resample_direction(const Rotation& home, std::uint64_t vertex, const FramedPlane& plane) {
    const Float4 here = point(vertex);
    const float height = height_over_plane(vertex);
    scaled = home * power_of_two(exponent);
    origin += here - point(vertex);
    over_plane = Float4{plane.along(scaled.x), plane.along(scaled.y), plane.along(scaled.z), 0};
    over_plane[3] = height - height_over_plane(vertex);
    deflected = false;
    note_change();
  }

 private:
  static float height(std::uint64_t word, const Float4& over) {
    const Float4 v = coordinates(word) * over;
    return v[0] + v[1] + v[2] + over[3];
  }
};

}  // namespace surf::mc
