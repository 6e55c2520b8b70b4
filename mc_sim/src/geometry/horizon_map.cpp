// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/horizon_map.h"

#include <algorithm>
#include <array>
#include <limits>

#include "surf/core/grid.h"
#include "surf/core/parallel.h"

namespace surf::mc {

namespace {

constexpr float nothing = -std::numeric_limits<float>::infinity();
constexpr int longest_side = 1000;  // columns; all farther rings are outside
constexpr double eighth = 0.78539816339744831;

float upward(double v) {
  const auto f = static_cast<float>(v);
  return static_cast<double>(f) >= v ? f
                                     : std::nextafter(f, std::numeric_limits<float>::infinity());
}

// Whether a triangle and a rectangle may overlap in the plane: separating axes, grown by rounding.
bool may_overlap(const Vec3 (&v)[3], double x, double y, double half) {
  for (int i = 0; i < 3; ++i) {
    const Vec3 edge = v[(i + 1) % 3] - v[i];
    const double nx = -edge.y, ny = edge.x;
    const double reach = half * (std::fabs(nx) + std::fabs(ny)) * (1 + 1e-9);
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const Vec3& corner : v) {
      const double at = nx * (corner.x - x) + ny * (corner.y - y);
      low = std::min(low, at);
      high = std::max(high, at);
    }
    if (low > reach || high < -reach) return false;
  }
  return true;
}

}  // namespace

class HorizonMapBuilder {
 public:
  HorizonMapBuilder(const MeshView& mesh, const Box& domain, std::size_t columns, HorizonMap& sky)
      : mesh_(mesh), sky_(sky) {
    const Vec3 size = domain.size_nm();
    const double longest = std::max({size.x, size.y, 1e-3});
    const double width =
        std::max({std::sqrt(size.x * size.y / static_cast<double>(columns)), longest / longest_side,
                  longest / static_cast<double>(columns)}) *
        (1 + 1e-9);
    sky.lower_x_ = domain.lower_nm.x;
    sky.lower_y_ = domain.lower_nm.y;
    sky.columns_per_nm_ = 1 / width;
    sky.nx_ = static_cast<int>(size.x / width) + 1;
    sky.ny_ = static_cast<int>(size.y / width) + 1;
  }

  void build(int threads, const Watch& watch) {
    exact_ = Grid<double>(sky_.nx_, sky_.ny_, -HUGE_VAL);
    slopes_ = Grid<float>(sky_.nx_, sky_.ny_, 0);
    constexpr std::size_t between_looks = 65536;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (t % between_looks == 0) watch.check();
      raise(mesh_.triangles[t]);
    }
    heights_.emplace_back(sky_.nx_, sky_.ny_, nothing);
    for (int y = 0; y < sky_.ny_; ++y)
      for (int x = 0; x < sky_.nx_; ++x) {
        heights_[0](x, y) = upward(exact_(x, y));
        sky_.around_.push_back(around(x, y));
        sky_.slopes_.push_back(steepest_around(x, y));
      }
    const auto rings = static_cast<int>(HorizonMap::rings);
    while (static_cast<int>(heights_.size()) <= level_of(rings - 1)) heights_.push_back(halved());
    sky_.heights_.assign(static_cast<std::size_t>(sky_.nx_) * static_cast<std::size_t>(sky_.ny_) *
                             HorizonMap::sectors * HorizonMap::rings,
                         upward(outside_));
    for (int ring = 0; ring < rings - 1; ++ring) {  // the last one is outside
      watch.check();
      fill(ring, threads);
    }
  }

 private:
  struct Offset {
    int x, y;
  };

  // Rings are made of blocks of 2^level columns, small against their radius.
  static int level_of(int ring) { return std::max(0, ring - 3); }

  double around(int x, int y) const {
    double highest = -HUGE_VAL;
    for (int v = y - 1; v <= y + 1; ++v)
      for (int u = x - 1; u <= x + 1; ++u)
        highest = std::max(
            highest, u >= 0 && v >= 0 && u < sky_.nx_ && v < sky_.ny_ ? exact_(u, v) : outside_);
    return highest;
  }

  // Where all surface faces upward there is one sheet of it, unbroken, and vacuum is above. From
  // there a ray that rises more steeply than any of it does not meet it.
  float steepest_around(int x, int y) const {
    float steepest = 0;
    for (int v = y - 1; v <= y + 1; ++v)
      for (int u = x - 1; u <= x + 1; ++u)
        steepest = std::max(
            steepest, u >= 0 && v >= 0 && u < sky_.nx_ && v < sky_.ny_ ? slopes_(u, v) : -nothing);
    return steepest;
  }

  static float slope(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 normal = cross(b - a, c - a);
    const double level = length(Vec3{normal.x, normal.y, 0});
    constexpr double steepest = 20;  // beyond, nothing is gained
    return normal.z > 0 && level < steepest * normal.z ? upward(level / normal.z * (1 + 1e-6))
                                                       : -nothing;
  }

  void raise(const Triangle& t) {
    const Vec3 shift{sky_.lower_x_, sky_.lower_y_, 0};
    Vec3 v[3];
    Box box;
    for (std::size_t i = 0; i < 3; ++i) {
      v[i] = mesh_.vertices_nm[t[i]] - shift;
      v[i].x *= sky_.columns_per_nm_;
      v[i].y *= sky_.columns_per_nm_;
      box.extend(v[i]);
    }
    const double top = box.upper_nm.z;
    const float steep =
        slope(mesh_.vertices_nm[t[0]], mesh_.vertices_nm[t[1]], mesh_.vertices_nm[t[2]]);
    constexpr double hair = 1e-6;  // columns
    if (box.lower_nm.x < 0 || box.lower_nm.y < 0 || box.upper_nm.x > sky_.nx_ ||
        box.upper_nm.y > sky_.ny_)
      outside_ = std::max(outside_, top);
    const auto first = [&](double at, int n) {
      return static_cast<int>(std::clamp(std::floor(at - hair), 0.0, double(n)));
    };
    const auto end = [&](double at, int n) {
      return static_cast<int>(std::clamp(std::floor(at + hair) + 1, 0.0, double(n)));
    };
    for (int y = first(box.lower_nm.y, sky_.ny_); y < end(box.upper_nm.y, sky_.ny_); ++y)
      for (int x = first(box.lower_nm.x, sky_.nx_); x < end(box.upper_nm.x, sky_.nx_); ++x) {
        double& height = exact_(x, y);
        float& slope_here = slopes_(x, y);
        if ((height < top || slope_here < steep) && may_overlap(v, x + 0.5, y + 0.5, 0.5 + hair)) {
          height = std::max(height, top);
          slope_here = std::max(slope_here, steep);
        }
      }
  }

  Grid<float> halved() const {
    const Grid<float>& fine = heights_.back();
    Grid<float> coarse((fine.width() + 1) / 2, (fine.height() + 1) / 2, nothing);
    for (int y = 0; y < fine.height(); ++y)
      for (int x = 0; x < fine.width(); ++x)
        coarse(x / 2, y / 2) = std::max(coarse(x / 2, y / 2), fine(x, y));
    // Blocks that reach beyond the domain hold something of what is there.
    if (fine.width() % 2)
      for (int y = 0; y < coarse.height(); ++y)
        coarse(coarse.width() - 1, y) = std::max(coarse(coarse.width() - 1, y), upward(outside_));
    if (fine.height() % 2)
      for (int x = 0; x < coarse.width(); ++x)
        coarse(x, coarse.height() - 1) = std::max(coarse(x, coarse.height() - 1), upward(outside_));
    return coarse;
  }

  // The blocks that a ray from somewhere in a block may be over while it is within the ring, by
  // sector.
  static std::array<std::vector<Offset>, HorizonMap::sectors> offsets(int ring) {
    std::array<std::vector<Offset>, HorizonMap::sectors> out;
    const double block = std::ldexp(1.0, level_of(ring));
    const double inner = std::ldexp(1.0, ring), outer = 2 * inner;
    const int most = static_cast<int>(outer / block) + 1;
    for (int y = -most; y <= most; ++y)
      for (int x = -most; x <= most; ++x) {
        const double nearest =
            std::hypot(std::max(0, std::abs(x) - 1), std::max(0, std::abs(y) - 1));
        const double farthest = std::hypot(std::abs(x) + 1, std::abs(y) + 1);
        if (nearest * block > outer || farthest * block < inner) continue;
        for (std::size_t k = 0; k < HorizonMap::sectors; ++k)
          if (may_be_in(k, x, y)) out[k].push_back({x, y});
      }
    return out;
  }

  // Whether the way from a block to the one at (x, y) from it may run in sector k.
  static bool may_be_in(std::size_t k, int x, int y) {
    if (std::abs(x) <= 1 && std::abs(y) <= 1) return true;
    const double about = std::atan2(y, x);
    double low = 0, high = 0;  // of the corners, about the middle
    for (const int dy : {-1, 1})
      for (const int dx : {-1, 1}) {
        const double turn = std::remainder(std::atan2(y + dy, x + dx) - about, 8 * eighth);
        low = std::min(low, turn);
        high = std::max(high, turn);
      }
    const double from = std::remainder(static_cast<double>(k) * eighth - about, 8 * eighth);
    for (const double start : {from - 8 * eighth, from, from + 8 * eighth})
      if (start <= high + 1e-6 && start + eighth >= low - 1e-6) return true;
    return false;
  }

  void fill(int ring, int threads) {
    const int level = level_of(ring);
    const Grid<float>& blocks = heights_[static_cast<std::size_t>(level)];
    const auto lists = offsets(ring);
    const float outside = upward(outside_);
    parallel_for(static_cast<std::size_t>(blocks.height()), threads, [&](std::size_t row, int) {
      const int by = static_cast<int>(row);
      for (int bx = 0; bx < blocks.width(); ++bx)
        for (std::size_t k = 0; k < HorizonMap::sectors; ++k) {
          float highest = nothing;
          for (const Offset& o : lists[k]) {
            const int x = bx + o.x, y = by + o.y;
            const bool inside = x >= 0 && y >= 0 && x < blocks.width() && y < blocks.height();
            highest = std::max(highest, inside ? blocks(x, y) : outside);
          }
          for (int y = by << level; y < std::min((by + 1) << level, sky_.ny_); ++y)
            for (int x = bx << level; x < std::min((bx + 1) << level, sky_.nx_); ++x) {
              const std::size_t column =
                  static_cast<std::size_t>(y) * static_cast<std::size_t>(sky_.nx_) +
                  static_cast<std::size_t>(x);
              sky_.heights_[(column * HorizonMap::sectors + k) * HorizonMap::rings +
                            static_cast<std::size_t>(ring)] = highest;
            }
        }
    });
  }

  const MeshView mesh_;
  HorizonMap& sky_;
  double outside_ = -HUGE_VAL;
  Grid<double> exact_;
  Grid<float> slopes_;
  std::vector<Grid<float>> heights_;  // of blocks of 2^level columns
};

HorizonMap::HorizonMap(const MeshView& mesh, const Box& domain, std::size_t columns, int threads,
                       const Watch& watch) {
  if (mesh.triangles.empty()) return;
  top_nm_ = bounds(mesh).upper_nm.z;
  if (columns == 0 || domain.empty()) return;
  HorizonMapBuilder(mesh, domain, columns, *this).build(resolve_threads(threads), watch);
}

}  // namespace surf::mc
