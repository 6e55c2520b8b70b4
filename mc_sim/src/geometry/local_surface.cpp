// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/local_surface.h"

#include <limits>
#include <utility>

#include "geometry/triangle_shape.h"

namespace surf::mc {

namespace {

constexpr std::size_t most_triangles = 1000;  // about a cube
constexpr double hair = 1e-4;  // nm: of rounding, and of paths that begin on a surface

}  // namespace

class LocalSurfaceBuilder {
 public:
  LocalSurfaceBuilder(LocalSurface& patch) : patch_(patch) {}

  void build(const EmbreeScene& triangles, std::optional<double> plane_nm) {
    float reach = 0;
    for (float r = 4 * LocalSurface::finest_nm; r <= LocalSurface::widest_nm; r *= 2) {
      near_.clear();
      if (!triangles.within(patch_.frame_.origin, 1.7321 * r + hair, most_triangles, near_)) break;
      std::swap(known_, near_);
      reach = r;
    }
    if (reach == 0) return;
    patch_.reach_nm_ = reach;
    // A ball within reach has less than the reach for its radius.
    levels_ = 1 + static_cast<int>(std::lround(std::log2(2 * reach / LocalSurface::finest_nm)));
    const auto columns = static_cast<std::size_t>(levels_ * across * across);
    bands_.assign(columns, {HUGE_VAL, -HUGE_VAL});
    patch_.lists_.resize(columns);
    for (const std::uint32_t t : known_) add(triangles.mesh(), t);
    if (plane_nm) add_plane(*plane_nm);
    pack();
    list();
  }

 private:
  static constexpr int across = LocalSurface::across;
  static constexpr std::uint16_t none = 0xffff;

  struct Heights {
    double low, high;
  };

  static double width(int level) { return double(LocalSurface::finest_nm) * (1 << level); }
  // Farther out nobody asks.
  double half(int level) const {
    return std::min(width(level) * (across / 2), double(patch_.reach_nm_)) + hair;
  }
  static double middle(int i, int level) { return (i + 0.5 - across / 2) * width(level); }
  static std::size_t column(int x, int y, int level) {
    return static_cast<std::size_t>((level * across + y) * across + x);
  }

  void add(const MeshView& mesh, std::uint32_t number) {
    const Triangle& t = mesh.triangles[number];
    Vec3 v[3];
    Box box;
    for (std::size_t i = 0; i < 3; ++i) {
      v[i] = patch_.frame_.in(mesh.vertices_nm[t[i]]);
      box.extend(v[i]);
    }
    const Vec3 extent = box.size_nm();
    const double size = std::max(extent.x, extent.y);
    const TriangleShape shape(v);
    // The plane's height is at + by_x x + by_y y, where the triangle is not upright.
    const bool sloped = !shape.is_needle() && std::fabs(shape.across.z) > 0.05 * shape.area2;
    const double by_x = sloped ? -shape.across.x / shape.across.z : 0;
    const double by_y = sloped ? -shape.across.y / shape.across.z : 0;
    std::uint16_t face = none;
    for (int level = 0; level < levels_; ++level) {
      const double w = width(level), h = half(level);
      if (box.lower_nm.x > h || box.lower_nm.y > h || box.lower_nm.z > h || box.upper_nm.x < -h ||
          box.upper_nm.y < -h || box.upper_nm.z < -h)
        continue;
      const auto first = [&](double low) {
        return static_cast<int>(
            std::clamp(std::ceil((low - hair) / w + across / 2 - 1.5), 0.0, double(across)));
      };
      const auto end = [&](double high) {
        return static_cast<int>(
            std::clamp(std::floor((high + hair) / w + across / 2 + 0.5) + 1, 0.0, double(across)));
      };
      const bool small = size < 0.2 * w;  // its box will do
      for (int y = first(box.lower_nm.y); y < end(box.upper_nm.y); ++y)
        for (int x = first(box.lower_nm.x); x < end(box.upper_nm.x); ++x) {
          const double mx = middle(x, level), my = middle(y, level);
          if (!small && !overlaps(v, mx, my, w + hair)) continue;
          double low = box.lower_nm.z, high = box.upper_nm.z;
          if (sloped) {
            const double at = v[0].z + by_x * (mx - v[0].x) + by_y * (my - v[0].y);
            const double off = (std::fabs(by_x) + std::fabs(by_y)) * (w + hair);
            low = std::max(low, at - off);
            high = std::min(high, at + off);
          }
          const std::size_t at = column(x, y, level);
          widen(bands_[at], low, high);
          if (++patch_.lists_[at].count > LocalSurface::most_faces) continue;
          if (face == none) {
            face = static_cast<std::uint16_t>(patch_.faces_.size());
            patch_.faces_.push_back(face_of(v, box, shape));
            patch_.numbers_.push_back(number);
          }
          pairs_.emplace_back(static_cast<std::uint32_t>(at), face);
        }
    }
  }

  // Whether a triangle and the square of a column with what is beside it overlap: separating axes.
  static bool overlaps(const Vec3 (&v)[3], double x, double y, double half) {
    for (int i = 0; i < 3; ++i) {
      const Vec3& a = v[i];
      const Vec3& b = v[(i + 1) % 3];
      const Vec3& c = v[(i + 2) % 3];
      const double nx = a.y - b.y, ny = b.x - a.x;
      const double reach = half * (std::fabs(nx) + std::fabs(ny));
      const double from = nx * (a.x - x) + ny * (a.y - y);
      const double to = nx * (c.x - x) + ny * (c.y - y);
      if (std::min(from, to) > reach || std::max(from, to) < -reach) return false;
    }
    return true;
  }

  static void widen(Heights& band, double low, double high) {
    band.low = std::min(band.low, low);
    band.high = std::max(band.high, high);
  }

  void pack() {
    patch_.bands_.resize(bands_.size());
    for (int level = 0; level < levels_; ++level) {
      const double unit = width(level) / double(LocalSurface::units);
      for (int i = 0; i < across * across; ++i) {
        const std::size_t at = column(i, 0, level);
        if (!(bands_[at].low <= bands_[at].high)) continue;
        // What is beyond these is beyond the cube.
        const auto whole = [&](double v) { return std::clamp(v, -32000.0, 32000.0); };
        patch_.bands_[at] = {
            static_cast<std::int16_t>(whole(std::floor((bands_[at].low - hair) / unit))),
            static_cast<std::int16_t>(whole(std::ceil((bands_[at].high + hair) / unit)))};
      }
    }
  }

  // The lists of triangles, column by column.
  void list() {
    std::uint32_t next = 0;
    for (LocalSurface::List& l : patch_.lists_) {
      l.first = next;
      if (l.count <= LocalSurface::most_faces) next += l.count;
    }
    patch_.listed_.resize(next);
    std::vector<std::uint32_t> filled(patch_.lists_.size());
    for (const auto& [at, number] : pairs_) {
      const LocalSurface::List& l = patch_.lists_[at];
      if (l.count > LocalSurface::most_faces) continue;
      patch_.listed_[l.first + filled[at]++] = number;
    }
  }

  static LocalSurface::Face face_of(const Vec3 (&v)[3], const Box& box,
                                    const TriangleShape& shape) {
    LocalSurface::Face out{
        Float4{},
        {static_cast<float>(box.lower_nm.x), static_cast<float>(box.lower_nm.y),
         static_cast<float>(box.upper_nm.x), static_cast<float>(box.upper_nm.y)}};
    if (shape.is_needle()) return out;
    const Vec3 normal = shape.across * (1 / shape.area2);
    out.plane = float4(normal);
    out.plane[3] = static_cast<float>(dot(normal, v[0]));
    return out;
  }

  // The endless horizontal surface.
  void add_plane(double z_nm) {
    const Frame& f = patch_.frame_;
    const Vec3 up{f.x.z, f.y.z, f.z.z};
    const double gap = z_nm - f.origin.z;
    patch_.has_level_ = true;
    patch_.level_ = float4(up);
    patch_.level_[3] = static_cast<float>(gap);
    for (int level = 0; level < levels_; ++level) {
      const double w = width(level) + hair, h = half(level);
      for (int y = 0; y < across; ++y)
        for (int x = 0; x < across; ++x) {
          const double mx = middle(x, level), my = middle(y, level);
          // What of up.p = gap lies in the column.
          const double low = gap - up.x * mx - up.y * my - (std::fabs(up.x) + std::fabs(up.y)) * w;
          const double high = gap - up.x * mx - up.y * my + (std::fabs(up.x) + std::fabs(up.y)) * w;
          double from = -h, to = h;
          if (std::fabs(up.z) > 0.05) {
            from = std::min(low / up.z, high / up.z);
            to = std::max(low / up.z, high / up.z);
          } else if (low > std::fabs(up.z) * h || high < -std::fabs(up.z) * h) {
            continue;
          }
          if (from > h || to < -h) continue;
          widen(bands_[column(x, y, level)], from, to);
        }
    }
  }

  LocalSurface& patch_;
  int levels_ = 0;
  std::vector<std::uint32_t> near_, known_;
  std::vector<Heights> bands_;
  std::vector<std::pair<std::uint32_t, std::uint16_t>> pairs_;  // column, face
};

LocalSurface::LocalSurface(const EmbreeScene& triangles, std::optional<double> plane_nm,
                           const Vec3& origin, const Vec3& normal)
    : frame_(frame_about(origin, normal)) {
  LocalSurfaceBuilder(*this).build(triangles, plane_nm);
}

}  // namespace surf::mc
