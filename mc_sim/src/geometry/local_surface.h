// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/embree_scene.h"
#include "geometry/rotation.h"
#include "surf/core/vec3.h"

namespace surf::mc {

/// Between which heights surfaces lie: nothing of them is below or above.
struct Band {
  float low = -HUGE_VALF, high = HUGE_VALF;  ///< nm; at first: nobody knows

  bool is_known() const { return low > -HUGE_VALF; }
  bool is_clear(float height, float radius) const {
    return height + radius < low || height - radius > high;
  }
  /// The same for what reaches from one height to another.
  bool is_beside(float a, float b) const { return std::max(a, b) < low || std::min(a, b) > high; }
};

/// All surface about one point, for many quick questions there.
///
/// A patch has a frame of its own: the point is its origin, z is the surface's normal there. Cubes
/// about the origin, each twice as large as the one before, are cut into 16 x 16 columns along z. A
/// column knows between which heights all surface lies in it and half a column's width beside it,
/// and, where they are few, the triangles. Places are in nm in the patch's frame.
class LocalSurface {
 public:
  /// `normal`: unit. `plane_nm`: the height of an endless horizontal surface in the specimen, if
  /// there is one. How far a patch reaches depends on how many triangles there are.
  LocalSurface(const EmbreeScene& triangles, std::optional<double> plane_nm, const Vec3& origin,
               const Vec3& normal);

  bool empty() const { return reach_nm_ == 0; }
  const Frame& frame() const { return frame_; }
  double reach_nm() const { return static_cast<double>(reach_nm_); }
  std::size_t bytes() const {
    return bands_.size() * sizeof(PackedBand) + lists_.size() * sizeof(List) +
           listed_.size() * sizeof(std::uint16_t) +
           faces_.size() * (sizeof(Face) + sizeof(std::uint32_t));
  }

  /// Between which heights all surface in a ball lies.
  Band band(const Float4& center, float radius) const {
    Place place;
    if (!find(center, radius, place)) return {};
    const PackedBand b = bands_[place.column];
    return {static_cast<float>(b.low) * place.unit, static_cast<float>(b.high) * place.unit};
  }

  /// The few triangles that come near a ball, and the endless plane.
  struct NearFaces {
    static constexpr std::size_t most = 12;
    std::array<std::uint16_t, most> numbers{};
    std::uint8_t count = 0;
    bool is_known = false;  ///< else there may be more
  };

  /// Those near a ball; not known where it has too many or lies too far from the patch's origin.
  void find_near(const Float4& center, float radius, NearFaces& out) const {
    out = {};
    Place place;
    if (!find(center, radius + search_nm, place) || place.column >= lists_.size()) return;
    const List& list = lists_[place.column];
    if (list.count > most_faces) return;
    for (std::size_t i = list.first; i < list.first + list.count; ++i) {
      if (is_far(faces_[listed_[i]], center, radius)) continue;
      if (out.count == NearFaces::most) return;
      out.numbers[out.count++] = listed_[i];
    }
    if (has_level_ && !is_beyond(level_, center, radius)) {
      if (out.count == NearFaces::most) return;
      out.numbers[out.count++] = the_level;
    }
    out.is_known = true;
  }

  /// Of those near a larger ball around this one.
  void keep_near(const Float4& center, float radius, NearFaces& faces) const {
    std::uint8_t kept = 0;
    for (std::uint8_t i = 0; i < faces.count; ++i) {
      const std::uint16_t n = faces.numbers[i];
      if (n == the_level ? is_beyond(level_, center, radius) : is_far(faces_[n], center, radius))
        continue;
      faces.numbers[kept++] = n;
    }
    faces.count = kept;
  }

  /// Unit normal and height of a triangle's plane; 0 where it has none.
  const Float4& plane(std::uint16_t number) const {
    return number == the_level ? level_ : faces_[number].plane;
  }

  static constexpr float search_nm = 2e-3f;  ///< searches begin within this before a way

  /// Triangles that a way may cross.
  struct Crossed {
    /// crowded: there are many, but fewer about a part of the way.
    enum class Answer { none, some, crowded, unknown } answer = Answer::unknown;
    std::array<std::uint32_t, 16> triangles;
    std::size_t count = 0;
  };

  /// Those that the straight way from `a` to `b` crosses, and maybe more. All of them lie near `a`
  /// or are crossed on the way.
  void crossed(const Float4& a, const Float4& b, Crossed& out) const {
    const Float4 half = (b - a) * 0.5f;
    Place place;
    out.answer = Crossed::Answer::unknown;
    if (!find(a + half, std::sqrt(squared_length(half)) + search_nm, place)) return;
    const PackedBand band = bands_[place.column];
    out.answer = Crossed::Answer::none;
    if (std::max(a[2], b[2]) + search_nm < static_cast<float>(band.low) * place.unit ||
        std::min(a[2], b[2]) - search_nm > static_cast<float>(band.high) * place.unit)
      return;
    out.answer = place.shrinks ? Crossed::Answer::crowded : Crossed::Answer::unknown;
    if (place.column >= lists_.size()) return;
    const List& list = lists_[place.column];
    if (list.count > most_faces) return;
    out.count = 0;
    for (std::size_t i = list.first; i < list.first + list.count; ++i) {
      const Face& face = faces_[listed_[i]];
      const float from = above(face.plane, a), to = above(face.plane, b);
      if (is_beside(from, to)) continue;
      const float fall = from - to;
      if (std::fabs(fall) > grazing_nm) {  // else rounding says little about where it is crossed
        const Float4 at = a + (b - a) * (from / fall);
        if (std::min({at[0] - face.box[0], at[1] - face.box[1], face.box[2] - at[0],
                      face.box[3] - at[1]}) < -search_nm)
          continue;
      }
      out.triangles[out.count++] = numbers_[listed_[i]];
    }
    const bool level = has_level_ && !is_beside(above(level_, a), above(level_, b));
    out.answer = out.count > 0 || level ? Crossed::Answer::some : Crossed::Answer::none;
  }

 private:
  friend class LocalSurfaceBuilder;
  static constexpr int across = 16;         // columns of a cube
  static constexpr float finest_nm = 0.5f;  // columns of the smallest cube
  static constexpr float widest_nm = 64;    // patch
  static constexpr float grazing_nm = 0.01f;
  static constexpr std::uint16_t the_level = 0xffff;  // in place of a face's number
  static constexpr std::uint32_t most_faces = 16;
  static constexpr float units = 3000;  // of height to a column's width

  struct PackedBand {
    std::int16_t low = 32767, high = -32767;  // no surface
  };
  struct List {
    std::uint32_t first = 0, count = 0;  // in listed_
  };
  struct Face {
    Float4 plane;  // unit normal, height of the plane; 0 where it has none
    Float4 box;    // lower x, y, upper x, y
  };
  struct Place {
    std::size_t column;
    float unit;
    bool shrinks;  // a smaller ball has a smaller column
  };

  static float above(const Float4& plane, const Float4& p) {
    const Float4 along = plane * p;
    return along[0] + along[1] + along[2] - plane[3];
  }
  static bool is_beyond(const Float4& plane, const Float4& center, float radius) {
    return std::fabs(above(plane, center)) > radius + search_nm;
  }
  static bool is_far(const Face& face, const Float4& center, float radius) {
    const float room = radius + search_nm;
    return is_beyond(face.plane, center, radius) || center[0] + room < face.box[0] ||
           center[1] + room < face.box[1] || center[0] - room > face.box[2] ||
           center[1] - room > face.box[3];
  }
  static bool is_beside(float from, float to) {
    return std::min(from, to) > search_nm || std::max(from, to) < -search_nm;
  }

  // The column of the smallest cube that answers for a ball; false where none does.
  bool find(const Float4& center, float radius, Place& place) const {
    const float reach =
        std::max({std::fabs(center[0]), std::fabs(center[1]), std::fabs(center[2])}) + radius;
    if (!(reach < reach_nm_)) return false;
    // Half a column's width beside the column is known, and half a cube about the origin.
    const float width = std::max({2 * radius, reach * (2.0f / across), finest_nm});
    // Widths are powers of two: the next one.
    const std::uint32_t power = (std::bit_cast<std::uint32_t>(width) + 0x7fffffu) & 0x7f800000u;
    const auto level = static_cast<int>((power - std::bit_cast<std::uint32_t>(finest_nm)) >> 23);
    const float per_nm = std::bit_cast<float>(0x7f000000u - power);
    const int x = std::min(static_cast<int>(center[0] * per_nm + across / 2), across - 1);
    const int y = std::min(static_cast<int>(center[1] * per_nm + across / 2), across - 1);
    place.column = static_cast<std::size_t>((level * across + y) * across + x);
    place.shrinks = 2 * radius >= width;
    place.unit = std::bit_cast<float>(power) * (1 / units);
    return true;
  }

  Frame frame_;
  float reach_nm_ = 0;
  bool has_level_ = false;  // the endless horizontal surface, as a plane
  Float4 level_{};
  std::vector<PackedBand> bands_;  // level, y, x
  std::vector<List> lists_;
  std::vector<std::uint16_t> listed_;  // numbers of faces
  std::vector<Face> faces_;
  std::vector<std::uint32_t> numbers_;  // their triangles
};

}  // namespace surf::mc
