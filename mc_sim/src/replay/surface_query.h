// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "geometry/geometry.h"
#include "geometry/local_surface.h"
#include "replay/branch_pose.h"
#include "replay/packed_heights.h"
#include "surf/core/vec3.h"

namespace surf::mc {

/// A geometry that takes a list of triangles beside which nothing need be looked for: an empty one
/// says nothing.
template <class G>
concept GeometryWithKnownFaces = Geometry<G> &&
    requires(G geometry, typename G::State state, typename G::Surface surface, const Vec3& v,
             double length, std::span<const std::uint32_t> faces) {
  { geometry.crossing(v, v, length, state, surface, faces) } -> std::same_as<Crossing>;
};

/// A ball around a point of the surface in which all surface lies in one plane, with matter on one
/// side and nothing but that matter within the ball.
template <class State>
struct FlatSurroundings {
  Vec3 point;          ///< on the plane: the ball's centre
  Vec3 normal;         ///< unit, out of the matter
  double radius = 0;   ///< 0: nothing is known
  bool whole = false;  ///< the ball holds all that starts at the point and stays inside
  State inside{};      ///< of the matter
  State outside{};
};

/// What is known of the surface around a part of a branch. Heights are over the flat surroundings'
/// plane where that is all the surface there is; else over the frame.
struct Near {
  bool flat = false;
  Band band;
  LocalSurface::NearFaces faces;  ///< all that there are, where they are known

  /// After a mirror in the flat surroundings' plane: what is not said of them alone is of another
  /// place.
  void forget_places() {
    band = {};
    faces = {};
  }
};

/// Answers where surfaces are around the current pixel: by its flat surroundings, by its patch,
/// then by the geometry. All of them prove that there is nothing, or find the same surface: which
/// one answers changes no result.
template <GeometryWithKnownFaces G>
class SurfaceQuery {
 public:
  using State = typename G::State;
  using Surface = typename G::Surface;

  explicit SurfaceQuery(G& geometry) : geometry_(geometry) {}

  /// `patch`: null, or one that stays until the next call.
  void at(const FlatSurroundings<State>& flat, const LocalSurface* patch) {
    flat_ = flat;
    patch_ = patch;
    frame_ = patch ? patch->frame() : Frame{};
    plane_.normal = float4(frame_.direction_in(flat.normal));
  }

  /// A primary enters here. Where there is no patch the frame's origin follows it: floats are
  /// finest there.
  void enter(const Vec3& here) {
    if (!patch_) frame_.origin = here;
    plane_.point = float4(frame_.in(flat_.point));
  }

  const Frame& frame() const { return frame_; }
  const FramedPlane& plane() const { return plane_; }
  const FlatSurroundings<State>& flat() const { return flat_; }

  /// Whether all of a sphere stays inside the material; else `near` is what is known around it.
  bool misses(BranchPose& pose, State state, std::uint64_t sphere, Near& near) const {
    const float radius = pose.radius(sphere);
    if (near.flat) return std::fabs(pose.height_over_plane(sphere)) > radius;
    const float height = pose.height_over_frame(sphere);
    if (near.band.is_clear(height, radius)) return true;
    const Float4 center = pose.point(sphere);
    if (is_flat_around(pose, state, center, radius)) {
      near.flat = true;
      pose.measure_from(plane_);
      return std::fabs(pose.height_over_plane(sphere)) > radius;
    }
    if (near.faces.is_known) {
      patch_->keep_near(center, radius, near.faces);
      return near.faces.count == 0;
    }
    near.band = {};
    if (patch_) {
      near.band = patch_->band(center, radius);
      if (near.band.is_clear(height, radius)) return true;
      patch_->find_near(center, radius, near.faces);
      if (near.faces.is_known) return near.faces.count == 0;
      if (near.band.high - near.band.low < radius) return false;  // it is met
    }
    return geometry_.clearance(frame_.out(vec3(center))) > radius;
  }

  /// Spheres that all stay inside the material, by what is known around a branch: bit i for sphere
  /// i. `misses` tells of more.
  unsigned clear_of(const BranchPose& pose, const std::uint64_t* spheres, int count,
                    const Near& near) const {
    if (near.flat) return PackedHeights(pose.over_plane, pose.exponent).clear(spheres, count);
    if (!near.faces.is_known) return 0;
    unsigned clear = (1u << count) - 1;
    for (std::uint8_t i = 0; i < near.faces.count; ++i)
      clear &=
          heights_over(near.faces.numbers[i], pose).clear(spheres, count, LocalSurface::search_nm);
    return clear;
  }

  /// Segments between `count` + 1 points, one after another, that may meet a surface: bit i for the
  /// segment that ends at point i + 1.
  unsigned may_meet(const BranchPose& pose, const std::uint64_t* points, int count,
                    const Near& near) const {
    if (near.flat)
      return PackedHeights(pose.over_plane, pose.exponent).may_be_above(points + 1, count);
    const unsigned all = (1u << count) - 1;
    if (!near.faces.is_known) return all;
    unsigned bits = 0;
    for (std::uint8_t i = 0; i < near.faces.count && bits != all; ++i) {
      const auto [above, below] = heights_over(near.faces.numbers[i], pose)
                                      .sides(points, count + 1, LocalSurface::search_nm);
      bits |= ~((above & above >> 1) | (below & below >> 1));
    }
    return bits & all;
  }

  /// Whether a way meets no surface. `first_crossing` of the same way, next, knows what was found.
  bool is_clear(const Float4& from, const Float4& way) {
    if (patch_) {
      patch_->crossed(from, from + way, crossed_);
      if (crossed_.answer != Answer::unknown && crossed_.answer != Answer::crowded)
        return crossed_.answer == Answer::none;
    }
    const double clear = geometry_.clearance(frame_.out(vec3(from + way * 0.5f)));
    return 4 * clear * clear > static_cast<double>(squared_length(way));
  }

  /// The first surface within `left` nm. Where triangles are many it is looked for bit by bit, each
  /// with few of them. `asked`: is_clear was asked about just this way. `rays` counts those that
  /// are traced.
  Crossing first_crossing(const Vec3& from, const Vec3& direction, double left, State& state,
                          Surface& surface, bool asked, std::int64_t& rays) {
    if (patch_) {
      const Vec3 begin = frame_.in(from), along = frame_.direction_in(direction);
      double done = 0, bit = left;
      for (;; asked = false) {
        if (!asked)
          patch_->crossed(float4(begin + along * done), float4(begin + along * (done + bit)),
                          crossed_);
        if (crossed_.answer == Answer::unknown) break;
        if (crossed_.answer == Answer::crowded) {
          if (bit < shortest_bit_nm) break;
          bit *= 0.5;
          continue;
        }
        if (crossed_.answer == Answer::some) {
          State ahead = state;
          const Crossing met =
              geometry_.crossing(from, direction, done + bit, ahead, surface,
                                 std::span(crossed_.triangles).first(crossed_.count));
          if (met != Crossing::none) {
            state = ahead;
            return met;
          }
          if (ahead != state) break;  // between bodies of one material: all faces must be known
        }
        done += bit;
        if (done >= left) return Crossing::none;
        bit = std::min(2 * bit, left - done);
      }
    }
    if (!asked && geometry_.clearance(from + direction * (0.5 * left)) > 0.5 * left)
      return Crossing::none;
    ++rays;
    return geometry_.crossing(from, direction, left, state, surface);
  }

 private:
  using Answer = LocalSurface::Crossed::Answer;

  /// Whether a sphere lies in the flat surroundings.
  bool is_flat_around(const BranchPose& pose, State state, const Float4& center,
                      float radius) const {
    if (state != flat_.inside) return false;
    if (flat_.whole && !pose.left_ball) return true;
    const double room = flat_.radius - radius;
    return room > 0 && squared_length(center - plane_.point) <= room * room;
  }

  PackedHeights heights_over(std::uint16_t face, const BranchPose& pose) const {
    const Float4& plane = patch_->plane(face);
    const auto along = [&](const Float4& v) {
      return plane[0] * v[0] + plane[1] * v[1] + plane[2] * v[2];
    };
    const Float4 over{along(pose.scaled.x), along(pose.scaled.y), along(pose.scaled.z),
                      along(pose.origin) - plane[3]};
    return PackedHeights(over, pose.exponent);
  }

  static constexpr double shortest_bit_nm = 0.1;

  G& geometry_;
  FlatSurroundings<State> flat_;
  const LocalSurface* patch_ = nullptr;
  Frame frame_;
  FramedPlane plane_;
  LocalSurface::Crossed crossed_;  // scratch
};

}  // namespace surf::mc
