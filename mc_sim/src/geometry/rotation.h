// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "physics/sin_cos.h"
#include "surf/core/vec3.h"

namespace surf::mc {

/// Four floats that the processor works on at once: x, y, z and one to spare.
using Float4 = float __attribute__((vector_size(16)));

inline Float4 float4(const Vec3& v) {
  return Float4{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), 0};
}
inline Vec3 vec3(const Float4& v) { return {v[0], v[1], v[2]}; }
inline float squared_length(const Float4& v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

/// A proper or improper rotation, by columns.
struct Rotation {
  Float4 x{1, 0, 0, 0}, y{0, 1, 0, 0}, z{0, 0, 1, 0};

  Float4 operator()(const Float4& v) const { return x * v[0] + y * v[1] + z * v[2]; }
  Rotation operator*(const Rotation& b) const { return {(*this)(b.x), (*this)(b.y), (*this)(b.z)}; }
  Rotation operator*(float scale) const { return {x * scale, y * scale, z * scale}; }
};

/// The mirror in a plane with this unit normal.
inline Rotation mirror(const Vec3& normal) {
  const Float4 n = float4(normal);
  const Rotation one;
  return {one.x - n * (2 * n[0]), one.y - n * (2 * n[1]), one.z - n * (2 * n[2])};
}

/// Takes the unit vector `from` to `to`, by the mirror in the plane between them: the medium has no
/// handedness.
inline Rotation turn(const Vec3& from, const Vec3& to) {
  const Vec3 between = from - to;
  const double squared = dot(between, between);
  return squared < 1e-24 ? Rotation{} : mirror(between * (1.0 / std::sqrt(squared)));
}

/// Takes -z to `to` by the smallest rotation, after a turn about z by `azimuth` turns in [0, 2).
inline Rotation beam_frame(const Vec3& to, double azimuth) {
  double s, c;
  sin_cos_turn(azimuth, s, c);
  const auto sine = static_cast<float>(s), cosine = static_cast<float>(c);
  const Rotation about_z{{cosine, sine, 0, 0}, {-sine, cosine, 0, 0}, {0, 0, 1, 0}};
  if (to.z > 0.9) return turn({0, 0, -1}, to) * about_z;  // there is no smallest one straight up
  const double k = 1.0 / (1.0 - to.z);
  const Rotation tilt{float4({1 - k * to.x * to.x, -k * to.x * to.y, to.x}),
                      float4({-k * to.x * to.y, 1 - k * to.y * to.y, to.y}),
                      float4({-to.x, -to.y, -to.z})};
  return tilt * about_z;
}

/// An origin and three axes of unit length at right angles to each other, in another frame.
struct Frame {
  Vec3 origin, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

  Vec3 direction_out(const Vec3& v) const { return x * v.x + y * v.y + z * v.z; }
  Vec3 direction_in(const Vec3& v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
  Vec3 out(const Vec3& p) const { return origin + direction_out(p); }
  Vec3 in(const Vec3& p) const { return direction_in(p - origin); }
};

/// A rotation in a frame's own axes.
inline Rotation rotation_in(const Frame& frame, const Rotation& r) {
  return {float4(frame.direction_in(vec3(r.x))), float4(frame.direction_in(vec3(r.y))),
          float4(frame.direction_in(vec3(r.z)))};
}

/// A frame with this unit vector as its z.
inline Frame frame_about(const Vec3& origin, const Vec3& z) {
  const Vec3 aside = std::fabs(z.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 x = normalized(aside - z * dot(aside, z));
  return {origin, x, cross(z, x), z};
}

}  // namespace surf::mc
