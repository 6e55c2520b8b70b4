// SPDX-License-Identifier: GPL-3.0-or-later
#include "face_tree.h"

#include <algorithm>
#include <array>
#include <limits>

#include "surf/core/parallel.h"

namespace surf::mc {

namespace {

constexpr std::size_t leaf_size = 4;
constexpr double needle = 1e-6;    // width over length of triangles whose plane is not trusted
constexpr double rounding = 1e-9;  // of what is computed from a ball, relative to its radius

Vec3 nearest_on_segment(const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double run = dot(ab, ab);
  const double t = run > 0 ? std::clamp(-dot(a, ab) / run, 0.0, 1.0) : 0.0;
  return a + ab * t;
}

// Twice the area, and the square of the longest side.
struct Shape {
  Vec3 across;
  double area2, longest_squared;

  explicit Shape(const Vec3 (&v)[3]) : across(cross(v[1] - v[0], v[2] - v[0])) {
    area2 = length(across);
    const Vec3 e[3] = {v[1] - v[0], v[2] - v[1], v[0] - v[2]};
    longest_squared = std::max({dot(e[0], e[0]), dot(e[1], e[1]), dot(e[2], e[2])});
  }
  bool is_needle() const { return !(area2 > needle * longest_squared); }
};

// The point of a triangle nearest to 0 (Ericson, Real-Time Collision Detection, 5.1.5).
Vec3 nearest_of_triangle(const Vec3 (&v)[3]) {
  const Vec3 ab = v[1] - v[0], ac = v[2] - v[0];
  const double d1 = -dot(ab, v[0]), d2 = -dot(ac, v[0]);
  if (d1 <= 0 && d2 <= 0) return v[0];
  const double d3 = -dot(ab, v[1]), d4 = -dot(ac, v[1]);
  if (d3 >= 0 && d4 <= d3) return v[1];
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return v[0] + ab * (d1 / (d1 - d3));
  const double d5 = -dot(ab, v[2]), d6 = -dot(ac, v[2]);
  if (d6 >= 0 && d5 <= d6) return v[2];
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return v[0] + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return v[1] + (v[2] - v[1]) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  const double scale = 1 / (va + vb + vc);
  return v[0] + ab * (vb * scale) + ac * (vc * scale);
}

// At most the distance of 0 from the triangle, and the point that it is taken to.
double distance_of(const Vec3 (&v)[3], Vec3& point) {
  const Shape shape(v);
  if (!shape.is_needle()) {
    point = nearest_of_triangle(v);
    return length(point);
  }
  // As good as its longest side; what lies beside that is allowed for.
  int longest = 0;
  double most = -1;
  for (int i = 0; i < 3; ++i) {
    const Vec3 e = v[(i + 1) % 3] - v[i];
    if (dot(e, e) > most) {
      most = dot(e, e);
      longest = i;
    }
  }
  point = nearest_on_segment(v[longest], v[(longest + 1) % 3]);
  return std::max(0.0, length(point) - needle * std::sqrt(most));
}

float outward(double v, bool up) {
  const auto f = static_cast<float>(v);
  constexpr float far = std::numeric_limits<float>::infinity();
  return std::nextafter(f, up ? far : -far);
}

}  // namespace

FaceTree::FaceTree(const TriangleMesh& mesh, const Box& region, int threads) : mesh_(mesh) {
  origin_ = region.center_nm();
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    const Vec3 &a = mesh.vertices_nm[t[0]], &b = mesh.vertices_nm[t[1]], &c = mesh.vertices_nm[t[2]];
    const auto apart = [&](double Vec3::*x) {
      return std::max({a.*x, b.*x, c.*x}) < region.lower_nm.*x ||
             std::min({a.*x, b.*x, c.*x}) > region.upper_nm.*x;
    };
    if (!apart(&Vec3::x) && !apart(&Vec3::y) && !apart(&Vec3::z)) faces_.push_back(i);
  }
  if (!faces_.empty()) build(threads);
}

void FaceTree::corners(std::uint32_t triangle, const Vec3& about, Vec3 (&out)[3]) const {
  const Triangle& t = mesh_.triangles[triangle];
  for (std::size_t i = 0; i < 3; ++i) out[i] = mesh_.vertices_nm[t[i]] - about;
}

void FaceTree::build(int threads) {
  struct Item {
    std::array<float, 3> middle;
    std::uint32_t triangle;
  };
  const std::size_t n = faces_.size();
  while ((n >> levels_) > leaf_size) ++levels_;
  std::vector<Item> items(n);
  parallel_for((n + 65535) / 65536, threads, [&](std::size_t block, int) {
    for (std::size_t i = block * 65536; i < std::min(n, (block + 1) * 65536); ++i) {
      Vec3 v[3];
      corners(faces_[i], origin_, v);
      const Vec3 sum = v[0] + v[1] + v[2];
      items[i] = {{static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z)},
                  faces_[i]};
    }
  });
  nodes_.resize((std::size_t{2} << levels_) - 1);
  const auto split = [&](std::size_t node, int level) {
    const Range all = range(node, level), half = range(2 * node + 1, level + 1);
    std::array<float, 3> low, high;
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
    for (std::size_t i = all.first; i < all.last; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], items[i].middle[k]);
        high[k] = std::max(high[k], items[i].middle[k]);
      }
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
    const auto at = [&](std::size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(all.first), at(half.last), at(all.last), [&](const Item& a, const Item& b) {
      return a.middle[axis] < b.middle[axis] ||
             (a.middle[axis] == b.middle[axis] && a.triangle < b.triangle);
    });
  };
  // The top one level at a time, then whole branches.
  const int top = std::min(levels_, 8);
  for (int level = 0; level < top; ++level)
    parallel_for(std::size_t{1} << level, threads, [&](std::size_t k, int) {
      split((std::size_t{1} << level) - 1 + k, level);
    });
  parallel_for(std::size_t{1} << top, threads, [&](std::size_t k, int) {
    for (int level = top; level <= levels_; ++level) {
      const std::size_t wide = std::size_t{1} << (level - top);
      const std::size_t first = (std::size_t{1} << level) - 1 + k * wide;
      if (level < levels_) {
        for (std::size_t node = first; node < first + wide; ++node) split(node, level);
        continue;
      }
      for (std::size_t node = first; node < first + wide; ++node) {
        const Range r = range(node, level);
        for (std::size_t i = r.first; i < r.last; ++i) faces_[i] = items[i].triangle;
      }
    }
    for (int level = levels_; level >= top; --level) {
      const std::size_t wide = std::size_t{1} << (level - top);
      const std::size_t first = (std::size_t{1} << level) - 1 + k * wide;
      for (std::size_t node = first; node < first + wide; ++node) bound(node, level);
    }
  });
  for (std::size_t node = (std::size_t{1} << top) - 1; node-- > 0;) bound(node, -1);
}

// The box of a leaf from its triangles, of any other node from its children.
void FaceTree::bound(std::size_t node, int level) {
  Node& box = nodes_[node];
  if (level != levels_) {
    const Node &a = nodes_[2 * node + 1], &b = nodes_[2 * node + 2];
    for (int k = 0; k < 3; ++k) {
      box.lower[k] = std::min(a.lower[k], b.lower[k]);
      box.upper[k] = std::max(a.upper[k], b.upper[k]);
    }
    return;
  }
  Box sum;
  const Range r = range(node, level);
  for (std::size_t i = r.first; i < r.last; ++i) {
    Vec3 v[3];
    corners(faces_[i], origin_, v);
    for (const Vec3& corner : v) sum.extend(corner);
  }
  const double lower[] = {sum.lower_nm.x, sum.lower_nm.y, sum.lower_nm.z};
  const double upper[] = {sum.upper_nm.x, sum.upper_nm.y, sum.upper_nm.z};
  for (int k = 0; k < 3; ++k) {
    box.lower[k] = outward(lower[k], false);
    box.upper[k] = outward(upper[k], true);
  }
}

// A node on its way, with its box about the centre asked for.
struct FaceTree::Entry {
  double squared;      // of the distance of the box
  double rank;         // lower ones go first
  double low, high;    // for slabs: what the box may hold across it
  std::size_t node;
  int level;
};

// Visits the triangles of the leaves that `worth` lets in, which is asked about every node when it
// is found, may then rank it, and is asked again by `still` when its turn comes.
template <class Worth, class Still, class Visit>
void FaceTree::walk(const Vec3& center, const Worth& worth, const Still& still,
                    const Visit& visit) const {
  if (faces_.empty()) return;
  const Vec3 c = center - origin_;
  std::array<Entry, 80> stack;
  std::size_t size = 0;
  const auto found = [&](std::size_t node, int level, Entry& e) {
    const Node& b = nodes_[node];
    const Vec3 lower = Vec3{b.lower[0], b.lower[1], b.lower[2]} - c;
    const Vec3 upper = Vec3{b.upper[0], b.upper[1], b.upper[2]} - c;
    const double x = std::max(std::max(0.0, lower.x), -upper.x);
    const double y = std::max(std::max(0.0, lower.y), -upper.y);
    const double z = std::max(std::max(0.0, lower.z), -upper.z);
    e.squared = (x * x + y * y + z * z) * (1 - rounding);
    e.node = node;
    e.level = level;
    return worth(lower, upper, e);
  };
  size += found(0, 0, stack[0]) ? 1 : 0;
  while (size > 0) {
    const Entry e = stack[--size];
    if (!still(e)) continue;
    if (e.level == levels_) {
      const Range r = range(e.node, e.level);
      for (std::size_t i = r.first; i < r.last; ++i)
        if (!visit(faces_[i])) return;
      continue;
    }
    const std::size_t before = size;
    size += found(2 * e.node + 1, e.level + 1, stack[size]) ? 1 : 0;
    size += found(2 * e.node + 2, e.level + 1, stack[size]) ? 1 : 0;
    if (size == before + 2 && stack[size - 2].rank < stack[size - 1].rank)
      std::swap(stack[size - 2], stack[size - 1]);
  }
}

void FaceTree::improve(const Vec3& p, std::uint32_t triangle, Nearest& best) const {
  Vec3 v[3], point;
  corners(triangle, p, v);
  const double distance = distance_of(v, point);
  if (distance < best.distance) best = {distance, triangle, p + point};
}

void FaceTree::improve(const Vec3& p, Nearest& best) const {
  const auto worth = [&](const Vec3&, const Vec3&, Entry& e) {
    e.rank = e.squared;
    return e.squared < best.distance * best.distance;
  };
  const auto still = [&](const Entry& e) { return e.squared < best.distance * best.distance; };
  const auto visit = [&](std::uint32_t triangle) {
    improve(p, triangle, best);
    return true;
  };
  walk(p, worth, still, visit);
}

FaceTree::Slab FaceTree::slab(const Vec3& center, double radius, const Vec3& n, double tolerance,
                              double useless) const {
  Slab s;
  const double nn = dot(n, n), reach = radius * (1 + rounding), reach_squared = reach * reach;
  const double margin = rounding * radius;
  const auto extend = [&](double low, double high) {
    s.low = std::min(s.low, low);
    s.high = std::max(s.high, high);
  };
  const auto still = [&](const Entry& e) {
    const double enough = tolerance + 0.1 * (s.high - s.low);
    if (e.low < s.low - enough || e.high > s.high + enough) return true;
    extend(e.low, e.high);
    return false;
  };
  const auto worth = [&](const Vec3& lower, const Vec3& upper, Entry& e) {
    if (e.squared > reach_squared) return false;
    e.low = std::max(n.x * (n.x > 0 ? lower.x : upper.x) + n.y * (n.y > 0 ? lower.y : upper.y) +
                         n.z * (n.z > 0 ? lower.z : upper.z), -reach);
    e.high = std::min(n.x * (n.x > 0 ? upper.x : lower.x) + n.y * (n.y > 0 ? upper.y : lower.y) +
                          n.z * (n.z > 0 ? upper.z : lower.z), reach);
    if (s.low > s.high) {
      e.rank = e.squared;
      return true;
    }
    // What may make the slab thickest goes first, and the rest is then mostly within it.
    e.rank = std::min(e.low - s.low, s.high - e.high);
    return still(e);
  };
  const auto visit = [&](std::uint32_t triangle) {
    Vec3 v[3];
    corners(triangle, center, v);
    const double a = dot(n, v[0]), b = dot(n, v[1]), c = dot(n, v[2]);
    double low = std::min({a, b, c}) - margin, high = std::max({a, b, c}) + margin;
    if (low >= s.low && high <= s.high) return true;
    const Shape shape(v);
    if (!shape.is_needle()) {
      // What lies both in the ball and in the triangle's plane is a disc.
      const Vec3 m = shape.across * (1 / shape.area2);
      const double off = dot(m, v[0]);
      if (std::fabs(off) > reach) return true;
      const double nm = dot(n, m);
      const double wide = std::sqrt(std::max(0.0, reach_squared - off * off)) *
                          std::sqrt(std::max(0.0, nn - nm * nm));
      low = std::max(low, off * nm - wide - margin);
      high = std::min(high, off * nm + wide + margin);
      if (low >= s.low && high <= s.high) return true;
    }
    Vec3 point;
    if (distance_of(v, point) > reach) return true;
    extend(low, high);
    if (!(s.low <= -useless && s.high >= useless)) return true;
    s = {-HUGE_VAL, HUGE_VAL};
    return false;
  };
  walk(center, worth, still, visit);
  return s;
}

Vec3 FaceTree::mean_normal(const Vec3& center, double radius) const {
  Vec3 sum;
  int left = 32;   // the nearest ones tell
  const double squared_radius = radius * radius;
  const auto worth = [&](const Vec3&, const Vec3&, Entry& e) {
    e.rank = e.squared;
    return e.squared <= squared_radius;
  };
  const auto still = [](const Entry&) { return true; };
  const auto visit = [&](std::uint32_t triangle) {
    Vec3 v[3];
    corners(triangle, center, v);
    const Shape shape(v);
    if (shape.is_needle()) return true;
    const Vec3 m = shape.across * (1 / shape.area2);
    const double off = dot(m, v[0]);
    const double disc = 3.14159265 * (squared_radius - off * off);
    if (disc <= 0) return true;
    const Vec3 nearest = nearest_of_triangle(v);
    const double seen = dot(nearest, nearest);
    if (seen < squared_radius)
      sum += m * (std::min(0.5 * shape.area2, disc) * (1 - seen / squared_radius));
    return --left > 0;
  };
  walk(center, worth, still, visit);
  return sum;
}

Vec3 FaceTree::normal(std::uint32_t triangle) const {
  Vec3 v[3];
  corners(triangle, mesh_.vertices_nm[mesh_.triangles[triangle][0]], v);
  const Shape shape(v);
  return shape.is_needle() ? Vec3{} : shape.across * (1 / shape.area2);
}

}  // namespace surf::mc
