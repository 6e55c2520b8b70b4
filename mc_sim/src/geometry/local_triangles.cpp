// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/local_triangles.h"

#include <algorithm>

#include "geometry/nearest_triangle.h"
#include "geometry/triangle_shape.h"

namespace surf::mc {

namespace {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));

constexpr double rounding = 1e-9;         // of doubles, relative to the ball
constexpr double single_rounding = 1e-6;  // of single precision
constexpr float nowhere = 1e18f;          // stands where fours are filled up

Float4 load(const std::vector<float>& v, std::size_t i) {
  return Float4{v[i], v[i + 1], v[i + 2], v[i + 3]};
}

Float4 all4(double v) {
  const auto f = static_cast<float>(v);
  return Float4{f, f, f, f};
}

bool any(const Int4& mask) {
  using Long2 = std::int64_t __attribute__((vector_size(16)));
  const Long2 m = reinterpret_cast<const Long2&>(mask);
  return (m[0] | m[1]) != 0;
}

Float4 less(const Float4& a, const Float4& b) { return a < b ? a : b; }
Float4 more(const Float4& a, const Float4& b) { return a > b ? a : b; }

}  // namespace

void LocalTriangles::add_face(const Vec3 (&v)[3], const Vec3& across, double area2, double radius) {
  Face f;
  for (std::size_t i = 0; i < 3; ++i) f.corners[i] = v[i];
  f.normal = area2 > 0 ? across * (1 / area2) : Vec3{};
  f.area2 = area2;
  // Of the bounding box: no sphere about it is much larger than need be.
  const auto half_way = [&](double Vec3::*x) {
    return 0.5 * (std::min({v[0].*x, v[1].*x, v[2].*x}) + std::max({v[0].*x, v[1].*x, v[2].*x}));
  };
  f.middle = {half_way(&Vec3::x), half_way(&Vec3::y), half_way(&Vec3::z)};
  double squared = 0;
  for (const Vec3& corner : v)
    squared = std::max(squared, dot(corner - f.middle, corner - f.middle));
  f.reach = std::sqrt(squared);
  all_.fx.push_back(static_cast<float>(f.middle.x));
  all_.fy.push_back(static_cast<float>(f.middle.y));
  all_.fz.push_back(static_cast<float>(f.middle.z));
  all_.reach.push_back(
      static_cast<float>(f.reach + single_rounding * (length(f.middle) + f.reach + radius)));
  all_.faces.push_back(static_cast<std::uint32_t>(faces_.size()));
  faces_.push_back(f);
}

void LocalTriangles::collect(const Vec3& center, double radius, double small) {
  triangles_.clear();
  append_within(tree_, center, radius, triangles_);
  faces_.clear();
  for (auto* v : {&all_.x, &all_.y, &all_.z, &all_.nx, &all_.ny, &all_.nz, &all_.fx, &all_.fy,
                  &all_.fz, &all_.reach})
    v->clear();
  all_.faces.clear();
  guess_ = 0;
  longest_ = 0;
  const MeshView& mesh = tree_.mesh();
  if (seen_.empty()) seen_.resize(mesh.vertices_nm.size());
  if (++lists_ == 0) {
    std::fill(seen_.begin(), seen_.end(), Seen{});
    lists_ = 1;
  }
  for (const std::uint32_t triangle : triangles_) {
    const Triangle& t = mesh.triangles[triangle];
    const Vec3 v[3] = {mesh.vertices_nm[t[0]] - center, mesh.vertices_nm[t[1]] - center,
                       mesh.vertices_nm[t[2]] - center};
    const Vec3 ab = v[1] - v[0], ac = v[2] - v[0], bc = v[2] - v[1];
    const double longest_squared = std::max({dot(ab, ab), dot(ac, ac), dot(bc, bc)});
    if (longest_squared > small * small) {
      const TriangleShape shape(v);
      add_face(v, shape.across, shape.is_needle() ? 0.0 : shape.area2, radius);
      continue;
    }
    longest_ = std::max(longest_, longest_squared);
    const Vec3 across = cross(ab, ac);
    for (std::size_t i = 0; i < 3; ++i) {
      Seen& seen = seen_[t[i]];
      if (seen.list != lists_) {
        seen = {lists_, static_cast<std::uint32_t>(all_.x.size())};
        all_.x.push_back(static_cast<float>(v[i].x));
        all_.y.push_back(static_cast<float>(v[i].y));
        all_.z.push_back(static_cast<float>(v[i].z));
        all_.nx.push_back(0);
        all_.ny.push_back(0);
        all_.nz.push_back(0);
      }
      all_.nx[seen.at] += static_cast<float>(across.x);
      all_.ny[seen.at] += static_cast<float>(across.y);
      all_.nz[seen.at] += static_cast<float>(across.z);
    }
  }
  longest_ = std::sqrt(longest_) * (1 + rounding);
  rounding_ = single_rounding * (radius + longest_);
  fill_up(all_);
}

void LocalTriangles::fill_up(Part& part) {
  while (part.x.size() % 4) {
    for (auto* v : {&part.x, &part.y, &part.z}) v->push_back(nowhere);
    for (auto* v : {&part.nx, &part.ny, &part.nz}) v->push_back(0);
  }
  while (part.faces.size() % 4) {
    for (auto* v : {&part.fx, &part.fy, &part.fz}) v->push_back(nowhere);
    part.reach.push_back(0);
    part.faces.push_back(0);
  }
}

// Visits the faces whose spheres come within `radius` of `p`; it may shrink on the way.
template <class Visit>
void LocalTriangles::visit_faces(const Part& part, const Vec3& p, const float& radius,
                                 const Visit& visit) const {
  const Float4 px = all4(p.x), py = all4(p.y), pz = all4(p.z);
  for (std::size_t i = 0; i < part.faces.size(); i += 4) {
    const Float4 x = load(part.fx, i) - px, y = load(part.fy, i) - py, z = load(part.fz, i) - pz;
    const Float4 beyond = load(part.reach, i) + radius;
    const Int4 in = x * x + y * y + z * z <= beyond * beyond;
    if (!any(in)) continue;
    for (std::size_t k = 0; k < 4; ++k)
      if (in[k]) visit(i + k);
  }
}

double LocalTriangles::improve(const Face& f, const Vec3& p, Nearest& best) const {
  const Vec3 v[3] = {f.corners[0] - p, f.corners[1] - p, f.corners[2] - p};
  Vec3 point;
  const double distance = distance_of_triangle(v, TriangleShape(v), point);
  if (distance < best.distance) best = {distance, distance > 1e-6 * f.reach ? -point : f.normal};
  return distance;
}

LocalTriangles::Nearest LocalTriangles::nearest(const Part& part, const Vec3& p) {
  Nearest best;
  if (!part.faces.empty()) {
    improve(faces_[guess_], p, best);
    auto within = static_cast<float>(best.distance);
    visit_faces(part, p, within, [&](std::size_t i) {
      const double before = best.distance;
      if (improve(faces_[part.faces[i]], p, best) >= before) return;
      guess_ = part.faces[i];
      within = static_cast<float>(best.distance);
    });
  }
  if (part.x.empty()) return best;
  const Float4 px = all4(p.x), py = all4(p.y), pz = all4(p.z);
  Float4 least = all4(1e38);
  for (std::size_t i = 0; i < part.x.size(); i += 4) {
    const Float4 x = load(part.x, i) - px, y = load(part.y, i) - py, z = load(part.z, i) - pz;
    least = less(x * x + y * y + z * z, least);
  }
  const float lowest = std::min({least[0], least[1], least[2], least[3]});
  // No point of a triangle is farther than its longest side / sqrt(3) from a corner.
  const double corner = std::max(0.0, std::sqrt(static_cast<double>(lowest)) - rounding_);
  const double distance = std::sqrt(std::max(0.0, corner * corner - longest_ * longest_ / 3));
  if (distance >= best.distance) return best;
  best = {distance, {}};
  for (std::size_t i = 0; corner > longest_ && i < part.x.size(); i += 4) {
    const Float4 x = load(part.x, i) - px, y = load(part.y, i) - py, z = load(part.z, i) - pz;
    const Float4 squared = x * x + y * y + z * z;
    for (int k = 0; k < 4; ++k)
      if (squared[k] <= lowest) {
        best.away = -Vec3{x[k], y[k], z[k]};
        return best;
      }
  }
  return best;
}

void LocalTriangles::narrow(const Part& part, const Vec3& p, double radius, Part& out) const {
  for (auto* v :
       {&out.x, &out.y, &out.z, &out.nx, &out.ny, &out.nz, &out.fx, &out.fy, &out.fz, &out.reach})
    v->clear();
  out.faces.clear();
  const auto reach = static_cast<float>(radius * (1 + single_rounding));
  visit_faces(part, p, reach, [&](std::size_t i) {
    const Face& f = faces_[part.faces[i]];
    if (!(f.normal == Vec3{}) && std::fabs(dot(f.normal, f.corners[0] - p)) > radius + rounding_)
      return;
    out.fx.push_back(part.fx[i]);
    out.fy.push_back(part.fy[i]);
    out.fz.push_back(part.fz[i]);
    out.reach.push_back(part.reach[i]);
    out.faces.push_back(part.faces[i]);
  });
  const auto limit = static_cast<float>(radius + longest_ + rounding_);
  const auto px = static_cast<float>(p.x), py = static_cast<float>(p.y),
             pz = static_cast<float>(p.z);
  for (std::size_t i = 0; i < part.x.size(); ++i) {
    const float x = part.x[i] - px, y = part.y[i] - py, z = part.z[i] - pz;
    if (x * x + y * y + z * z > limit * limit) continue;
    out.x.push_back(part.x[i]);
    out.y.push_back(part.y[i]);
    out.z.push_back(part.z[i]);
    out.nx.push_back(part.nx[i]);
    out.ny.push_back(part.ny[i]);
    out.nz.push_back(part.nz[i]);
  }
  fill_up(out);
}

void LocalTriangles::look_at(const Part& part, const Vec3& p, double radius) {
  part_ = &part;
  center_ = p;
  radius_ = radius;
  candidates_.clear();
  const auto reach = static_cast<float>(radius * (1 + single_rounding));
  visit_faces(part, p, reach, [&](std::size_t i) {
    const Face& f = faces_[part.faces[i]];
    if (!(f.normal == Vec3{}) && std::fabs(dot(f.normal, f.corners[0] - p)) > radius + rounding_)
      return;
    candidates_.push_back({part.faces[i], f.reach < 0.1 * radius ? Place::within : Place::unknown});
  });
}

LocalTriangles::Slab LocalTriangles::slab(const Vec3& n) {
  const Part& part = *part_;
  const Vec3 p = center_;
  const double radius = radius_;
  Slab s;
  const double nn = dot(n, n), reach = radius * (1 + rounding), margin = rounding * radius;
  for (Candidate& candidate : candidates_) {
    if (candidate.place == Place::beyond) continue;
    const Face& f = faces_[candidate.face];
    const Vec3 v[3] = {f.corners[0] - p, f.corners[1] - p, f.corners[2] - p};
    const double a = dot(n, v[0]), b = dot(n, v[1]), c = dot(n, v[2]);
    double low = std::min({a, b, c}) - margin, high = std::max({a, b, c}) + margin;
    if (low >= s.low && high <= s.high) continue;
    if (!(f.normal == Vec3{})) {
      // What lies both in the ball and in the triangle's plane is a disc.
      const double off = dot(f.normal, v[0]), nm = dot(n, f.normal);
      const double wide =
          std::sqrt(std::max(0.0, reach * reach - off * off) * std::max(0.0, nn - nm * nm));
      low = std::max(low, off * nm - wide - margin);
      high = std::min(high, off * nm + wide + margin);
      if (low >= s.low && high <= s.high) continue;
    }
    if (candidate.place == Place::unknown) {
      Nearest here;
      candidate.place = improve(f, p, here) > reach ? Place::beyond : Place::within;
      if (candidate.place == Place::beyond) continue;
    }
    s.low = std::min(s.low, low);
    s.high = std::max(s.high, high);
  }
  if (part.x.empty()) return s;
  // A triangle that comes within the ball has its corners no farther than a side outside of it.
  const double limit = radius + longest_ + rounding_;
  const Float4 px = all4(p.x), py = all4(p.y), pz = all4(p.z), squared = all4(limit * limit);
  const Float4 nx = all4(n.x), ny = all4(n.y), nz = all4(n.z);
  const Float4 far = all4(1e30);
  Float4 low = far, high = -far;
  for (std::size_t i = 0; i < part.x.size(); i += 4) {
    const Float4 x = load(part.x, i) - px, y = load(part.y, i) - py, z = load(part.z, i) - pz;
    const Float4 along = nx * x + ny * y + nz * z;
    const Int4 in = x * x + y * y + z * z <= squared;
    low = less(in ? along : far, low);
    high = more(in ? along : -far, high);
  }
  const double lowest = std::min({low[0], low[1], low[2], low[3]});
  const double highest = std::max({high[0], high[1], high[2], high[3]});
  if (lowest <= highest) {
    s.low = std::min(s.low, std::max(lowest - rounding_, -reach));
    s.high = std::max(s.high, std::min(highest + rounding_, reach));
  }
  return s;
}

Vec3 LocalTriangles::mean_normal() const {
  const Part& part = *part_;
  const Vec3 p = center_;
  const double radius = radius_, squared_radius = radius * radius;
  Vec3 sum;
  for (const Candidate& candidate : candidates_) {
    const Face& f = faces_[candidate.face];
    if (f.normal == Vec3{} || candidate.place == Place::beyond) continue;
    const double off = dot(f.normal, f.corners[0] - p);
    const double disc = 3.14159265 * (squared_radius - off * off);
    const double seen = std::max(std::fabs(off), length(f.middle - p) - f.reach);
    if (disc <= 0 || seen >= radius) continue;
    sum += f.normal * (std::min(0.5 * f.area2, disc) * (1 - seen * seen / squared_radius));
  }
  if (part.x.empty()) return sum;
  const Float4 px = all4(p.x), py = all4(p.y), pz = all4(p.z);
  const Float4 scale = all4(1 / squared_radius), one = all4(1), zero = all4(0);
  Float4 sx = zero, sy = zero, sz = zero;
  for (std::size_t i = 0; i < part.x.size(); i += 4) {
    const Float4 x = load(part.x, i) - px, y = load(part.y, i) - py, z = load(part.z, i) - pz;
    const Float4 weight = more(one - (x * x + y * y + z * z) * scale, zero);
    sx += weight * load(part.nx, i);
    sy += weight * load(part.ny, i);
    sz += weight * load(part.nz, i);
  }
  // Every small triangle is counted at its three corners.
  const auto total = [](const Float4& v) {
    return static_cast<double>(v[0] + v[1] + v[2] + v[3]) / 6;
  };
  return sum + Vec3{total(sx), total(sy), total(sz)};
}

}  // namespace surf::mc
