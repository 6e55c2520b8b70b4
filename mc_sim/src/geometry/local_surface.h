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
  float low = -HUGE_VALF, high = HUGE_VALF;   ///< nm; at first: nobody knows

  bool is_known() const { return low > -HUGE_VALF; }
  bool is_clear(float height, float radius) const {
    return height + radius < low || height - radius > high;
  }
  /// The same for what reaches from one height to another.
  bool is_beside(float a, float b) const {
    return std::max(a, b) < low || std::min(a, b) > high;
  }
};

/// All surface about one point, for many quick questions there.
///
/// A patch has a frame of its own: the point is its origin, z is the surface's normal there. Cubes
/// about the origin, each twice as large as the one before, are cut into 16 x 16 columns along z. A
/// column knows between which heights all surface lies in it and half a column's width beside it, and,
/// where they are few, the triangles. Places are in nm in the patch's frame.
class LocalSurface {
 public:
  /// `normal`: unit. `plane_nm`: the height of an endless horizontal surface in the specimen, if there
  /// is one. How far a patch reaches depends on how many triangles there are.
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

  /// Triangles that a way may cross.
  struct Crossed {
    /// crowded: there are many, but fewer about a part of the way.
    enum class Answer { none, some, crowded, unknown } answer = Answer::unknown;
    std::array<std::uint32_t, 16> triangles;
    std::size_t count = 0;
  };

  /// Those that the straight way from `a` to `b` crosses, and maybe more. All of them lie near `a` or
  /// are crossed on the way.
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
      if (std::fabs(fall) > grazing_nm) {   // else rounding says little about where it is crossed
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
  static constexpr int across = 16;              // columns of a cube
  static constexpr float finest_nm = 0.5f;       // columns of the smallest cube
  static constexpr float widest_nm = 64;         // patch
  static constexpr float search_nm = 2e-3f;      // searches begin within this before a way
  static constexpr float grazing_nm = 0.01f;
  static constexpr int listing_levels = 4;       // the finest ones
  static constexpr std::uint32_t most_faces = 16;
  static constexpr float units = 3000;           // of height to a column's width

  struct PackedBand {
    std::int16_t low = 32767, high = -32767;     // no surface
  };
  struct List {
    std::uint32_t first = 0, count = 0;          // in listed_
  };
  struct Face {
    Float4 plane;             // unit normal, height of the plane; 0 where it has none
    Float4 box;               // lower x, y, upper x, y
  };
  struct Place {
    std::size_t column;
    float unit;
    bool shrinks;             // a smaller ball has a smaller column
  };

  static float above(const Float4& plane, const Float4& p) {
    const Float4 along = plane * p;
    return along[0] + along[1] + along[2] - plane[3];
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
  bool has_level_ = false;                // the endless horizontal surface, as a plane
  Float4 level_{};
  std::vector<PackedBand> bands_;         // level, y, x
  std::vector<List> lists_;
  std::vector<std::uint16_t> listed_;     // numbers of faces
  std::vector<Face> faces_;
  std::vector<std::uint32_t> numbers_;    // their triangles
};

}  // namespace surf::mc
