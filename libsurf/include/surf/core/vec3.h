// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace surf {

/// A point or direction in the specimen frame: right-handed, z up towards the gun.
/// Lengths are nm; directions are unit vectors.
struct Vec3 {
  double x = 0;
  double y = 0;
  double z = 0;

  constexpr Vec3& operator+=(const Vec3& b) {
    x += b.x;
    y += b.y;
    z += b.z;
    return *this;
  }
  constexpr Vec3& operator-=(const Vec3& b) {
    x -= b.x;
    y -= b.y;
    z -= b.z;
    return *this;
  }
  constexpr Vec3& operator*=(double s) {
    x *= s;
    y *= s;
    z *= s;
    return *this;
  }
  friend constexpr Vec3 operator+(Vec3 a, const Vec3& b) { return a += b; }
  friend constexpr Vec3 operator-(Vec3 a, const Vec3& b) { return a -= b; }
  friend constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3 operator*(Vec3 a, double s) { return a *= s; }
  friend constexpr Vec3 operator*(double s, Vec3 a) { return a *= s; }
  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

constexpr double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

constexpr Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline double length(const Vec3& a) { return std::sqrt(dot(a, a)); }

/// The unit vector along `a`. `a` must not be zero.
inline Vec3 normalized(const Vec3& a) { return a * (1.0 / length(a)); }

inline bool is_finite(const Vec3& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// An axis-aligned box in nm. Empty (lower > upper) until extended.
struct Box {
  Vec3 lower_nm{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  Vec3 upper_nm{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  bool empty() const { return !(lower_nm.x <= upper_nm.x); }
  Vec3 size_nm() const { return upper_nm - lower_nm; }
  Vec3 center_nm() const { return (lower_nm + upper_nm) * 0.5; }

  /// NaN coordinates are ignored.
  void extend(const Vec3& p) {  // std::fmin would call the C library
    lower_nm.x = p.x < lower_nm.x ? p.x : lower_nm.x;
    lower_nm.y = p.y < lower_nm.y ? p.y : lower_nm.y;
    lower_nm.z = p.z < lower_nm.z ? p.z : lower_nm.z;
    upper_nm.x = p.x > upper_nm.x ? p.x : upper_nm.x;
    upper_nm.y = p.y > upper_nm.y ? p.y : upper_nm.y;
    upper_nm.z = p.z > upper_nm.z ? p.z : upper_nm.z;
  }
  void extend(const Box& b) {
    if (b.empty()) return;
    extend(b.lower_nm);
    extend(b.upper_nm);
  }
};

}  // namespace surf
