// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/merge_coplanar.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "core/argument.h"
#include "mesh/cgal_triangulate.h"
#include "mesh/edges.h"

namespace surf {
namespace {

constexpr std::uint32_t none = 0xffffffffu;
constexpr std::size_t watched_size = 4096;  // triangles between checks of the watch
// Triangles with a smaller ratio of width to length do not define a plane.
constexpr double needle = 1e-6;
constexpr std::size_t worth_grading = 64;  // least number of triangles of a region
// Relative rounding of a region's area before and after.
constexpr double area_rounding = 1e-9;

// Finds regions of coplanar triangles, straightens their outlines and triangulates them again.
class CoplanarRegions {
 public:
  CoplanarRegions(TriangleMesh& mesh, const MergeCoplanarOptions& options)
      : mesh_(mesh), tolerance_(options.tolerance_nm), watch_(options.watch) {}

  void merge() {
    find_neighbours();
    find_regions();
    if (first_of_.size() == mesh_.triangles.size())
      return;  // every triangle is a region of its own
    do drop_corners();
    while (!fill_all());
    replace();
  }

 private:
  Vec3 at(std::uint32_t vertex) const { return mesh_.vertices_nm[vertex]; }
  std::uint32_t corner(std::size_t triangle, std::size_t k) const {
    return mesh_.triangles[triangle][k % 3];
  }

  void look(std::size_t i) const {
    if (i % watched_size == 0) watch_.check();
  }

  // The triangle across each side, if there is exactly one and it traverses the edge in the other
  // direction.
  void find_neighbours() {
    const std::size_t n = mesh_.triangles.size();
    neighbours_.assign(3 * n, none);
    const Buckets edges = gather(mesh_.vertices_nm.size(), [&](const auto& put) {
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t a = corner(i, k), b = corner(i, k + 1);
          put(std::min(a, b),
              std::uint64_t{std::max(a, b)} << 32 | static_cast<std::uint32_t>(3 * i + k));
        }
    });
    for (std::size_t p = 0; p + 1 < edges.begin.size(); ++p)
      for (std::size_t i = edges.begin[p]; i < edges.begin[p + 1];) {
        look(i);
        std::size_t end = i + 1;
        while (end < edges.begin[p + 1] && edges.values[end] >> 32 == edges.values[i] >> 32) ++end;
        if (end == i + 2) {
          const auto s = static_cast<std::uint32_t>(edges.values[i]),
                     t = static_cast<std::uint32_t>(edges.values[i + 1]);
          if (mesh_.triangles[s / 3][s % 3] != mesh_.triangles[t / 3][t % 3]) {
            neighbours_[s] = t / 3;
            neighbours_[t] = s / 3;
          }
        }
        i = end;
      }
  }

  void find_regions() {
    const std::size_t n = mesh_.triangles.size();
    region_.assign(n, none);
    std::vector<std::uint32_t> open;
    for (std::uint32_t seed = 0; seed < n; ++seed) {
      look(seed);
      if (region_[seed] != none) continue;
      const auto number = static_cast<std::uint32_t>(first_of_.size());
      first_of_.push_back(seed);
      size_of_.push_back(1);
      region_[seed] = number;
      const Vec3 a = at(corner(seed, 0)), ab = at(corner(seed, 1)) - a,
                 ac = at(corner(seed, 2)) - a;
      Vec3 normal = cross(ab, ac);
      const double area2 = length(normal),
                   longest = std::max({dot(ab, ab), dot(ac, ac), dot(ac - ab, ac - ab)});
      normal_of_.push_back(area2 > 0 ? normal * (1 / area2) : Vec3{});
      if (!(area2 > needle * longest)) continue;
      normal = normal_of_.back();
      open.assign(1, seed);
      while (!open.empty()) {
        const std::uint32_t t = open.back();
        open.pop_back();
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t u = neighbours_[3 * t + k];
          if (u == none || region_[u] != none || !lies_in(u, a, normal)) continue;
          region_[u] = number;
          ++size_of_.back();
          open.push_back(u);
        }
      }
    }
  }

  bool lies_in(std::uint32_t triangle, const Vec3& point, const Vec3& normal) const {
    Vec3 v[3];
    for (std::size_t k = 0; k < 3; ++k) {
      v[k] = at(corner(triangle, k)) - point;
      if (!(std::fabs(dot(v[k], normal)) <= tolerance_)) return false;
    }
    return dot(cross(v[1] - v[0], v[2] - v[0]), normal) > 0;
  }

  bool is_merged(std::uint32_t region) const { return size_of_[region] > 1; }

  // Calls visit(triangle, k) for the sides at the outlines of regions.
  template <class Visit>
  void for_outline(const Visit& visit) const {
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t u = neighbours_[3 * i + k];
        if (u == none || region_[u] != region_[i]) visit(i, k);
      }
  }

  // A corner is dropped from both outlines if exactly two outlines pass it, in opposite directions
  // and straight.
  void drop_corners() {
    struct Passing {
      std::uint32_t next = none, before = none;  // neighbours on the first outline
      std::uint8_t begin = 0, end = 0;           // outline sides that begin or end here
      bool fixed = false;
    };
    std::vector<Passing> passing(mesh_.vertices_nm.size());
    for_outline([&](std::size_t i, std::size_t k) {
      Passing& from = passing[corner(i, k)];
      Passing& to = passing[corner(i, k + 1)];
      if (from.begin < 3) ++from.begin;
      if (to.end < 3) ++to.end;
      if (!is_merged(region_[i]) || neighbours_[3 * i + k] == none) from.fixed = to.fixed = true;
      if (from.begin == 1) from.next = corner(i, k + 1);
      else if (from.before == none && corner(i, k + 1) != from.next) from.before = corner(i, k + 1);
    });
    dropped_.assign(mesh_.vertices_nm.size(), 0);
    const auto is_straight = [&](std::uint32_t v) {
      const Passing& p = passing[v];
      if (p.fixed || p.begin != 2 || p.end != 2 || p.before == none) return false;
      return lies_on(v, p.before, p.next);
    };
    for (std::uint32_t v = 0; v < passing.size(); ++v) dropped_[v] = is_straight(v) ? 1 : 0;
    // On each straight run, keeps the corners that are off the line between its ends by more than
    // the tolerance.
    std::vector<std::uint8_t> seen(passing.size(), 0);
    std::vector<std::uint32_t> run;
    for (std::uint32_t v = 0; v < passing.size(); ++v) {
      look(v);
      if (!dropped_[v] || seen[v]) continue;
      run.assign(1, v);
      const auto walk = [&](std::uint32_t from,
                            // Walks to the end of the run, which is kept.
                            std::uint32_t to) {
        run.push_back(to);
        while (dropped_[to] && to != v) {
          const Passing& p = passing[to];
          const std::uint32_t ahead = p.next == from ? p.before : p.next;
          from = std::exchange(to, ahead);
          run.push_back(to);
        }
      };
      walk(v, passing[v].next);
      if (run.back() == v) {  // a closed run, by accumulated rounding
        for (const std::uint32_t u : run) dropped_[u] = 0;
        continue;
      }
      std::ranges::reverse(run);
      walk(v, passing[v].before);
      for (const std::uint32_t u : run) seen[u] = dropped_[u];
      keep_off_line(run);
    }
  }

  bool lies_on(std::uint32_t v, std::uint32_t a, std::uint32_t b) const {
    const Vec3 along = at(b) - at(a), to = at(v) - at(a);
    const double squared = dot(along, along), share = dot(to, along);
    return squared > 0 && share > 0 && share < squared &&
           length(to - along * (share / squared)) <= tolerance_;
  }

  // The algorithm of Ramer, Douglas and Peucker.
  void keep_off_line(const std::vector<std::uint32_t>& run) {
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, run.size() - 1}};
    while (!open.empty()) {
      const auto [first, last] = open.back();
      open.pop_back();
      const Vec3 a = at(run[first]), along = at(run[last]) - a;
      const double squared = dot(along, along);
      double farthest = tolerance_;
      std::size_t found = first;
      for (std::size_t i = first + 1; i < last; ++i) {
        const Vec3 to = at(run[i]) - a;
        const double share = squared > 0 ? std::clamp(dot(to, along) / squared, 0.0, 1.0) : 0.0;
        const double off = length(to - along * share);
        if (!(off > farthest)) continue;
        farthest = off;
        found = i;
      }
      if (found == first) continue;
      dropped_[run[found]] = 0;
      open.emplace_back(first, found);
      open.emplace_back(found, last);
    }
  }

  // Returns false if a region could not be filled. That region keeps its triangles and corners, and
  // all regions must be filled again.
  bool fill_all() {
    const std::size_t regions = first_of_.size();
    const Buckets outlines = gather(regions, [&](const auto& put) {
      for_outline([&](std::size_t i, std::size_t k) {
        if (is_merged(region_[i])) put(region_[i], 3 * i + k);
      });
    });
    std::vector<double> area(regions, 0);
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i)
      if (is_merged(region_[i]))
        area[region_[i]] += area2_of(mesh_.triangles[i], normal_of_[region_[i]]);
    filled_.assign(regions, {});
    bool all = true;
    for (std::uint32_t r = 0; r < regions; ++r) {
      if (!is_merged(r)) continue;
      look(r);
      fill(r, std::span(outlines.values)
                  .subspan(outlines.begin[r], outlines.begin[r + 1] - outlines.begin[r]));
      double after = 0, outline = 0;
      for (const Triangle& t : filled_[r]) after += area2_of(t, normal_of_[r]);
      for (std::size_t i = outlines.begin[r]; i < outlines.begin[r + 1]; ++i)
        outline += length(at(corner(outlines.values[i] / 3, outlines.values[i] % 3 + 1)) -
                          at(corner(outlines.values[i] / 3, outlines.values[i] % 3)));
      const double rounding = area_rounding * area[r] + 2 * tolerance_ * outline;
      if (!filled_[r].empty() && filled_[r].size() <= size_of_[r] &&
          std::fabs(after - area[r]) <= rounding)
        continue;
      size_of_[r] = 1;
      all = false;
    }
    return all;
  }

  double area2_of(const Triangle& t, const Vec3& normal) const {
    return dot(cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0])), normal);
  }

  void fill(std::uint32_t region, std::span<const std::uint64_t> outline) {
    // Projects along the axis nearest to the normal, so that lines parallel to another axis stay
    // straight.
    const Vec3 n = normal_of_[region];
    const double x = std::fabs(n.x), y = std::fabs(n.y), z = std::fabs(n.z);
    double Vec3::*u = &Vec3::x;
    double Vec3::*v = &Vec3::y;
    double toward = n.z;
    if (x > y && x > z) std::tie(u, v, toward) = std::make_tuple(&Vec3::y, &Vec3::z, n.x);
    else if (y > z) std::tie(u, v, toward) = std::make_tuple(&Vec3::z, &Vec3::x, n.y);
    if (toward < 0) std::swap(u, v);
    std::vector<std::array<double, 2>> points;
    std::vector<std::uint32_t> vertices;
    std::unordered_map<std::uint32_t, std::uint32_t> number;
    const auto point = [&](std::uint32_t vertex) {
      const auto [place, is_new] =
          number.try_emplace(vertex, static_cast<std::uint32_t>(points.size()));
      if (is_new) {
        points.push_back({at(vertex).*u, at(vertex).*v});
        vertices.push_back(vertex);
      }
      return place->second;
    };
    // Connects each kept corner to the next kept one.
    std::unordered_map<std::uint32_t, std::uint32_t> after_dropped;
    for (const std::uint64_t s : outline)
      if (dropped_[corner(s / 3, s % 3)])
        after_dropped[corner(s / 3, s % 3)] = corner(s / 3, s % 3 + 1);
    std::vector<PlanarEdge> edges;
    for (const std::uint64_t s : outline) {
      const std::uint32_t from = corner(s / 3, s % 3);
      if (dropped_[from]) continue;
      std::uint32_t to = corner(s / 3, s % 3 + 1);
      while (dropped_[to]) to = after_dropped.at(to);
      const std::uint32_t a = point(from);
      edges.push_back({a, point(to)});
    }
    const std::size_t outer = points.size();
    std::vector<Triangle>& filled = filled_[region];
    if (size_of_[region] >= worth_grading) filled = triangulate_region(points, edges, true);
    if (filled.empty() || 2 * filled.size() > size_of_[region]) {
      points.resize(outer);
      filled = triangulate_region(points, edges, false);
    }
    // New points lie in the plane through the first corner.
    const Vec3 a = at(vertices[0]);
    double Vec3::*const w = x > y && x > z ? &Vec3::x : y > z ? &Vec3::y : &Vec3::z;
    for (std::size_t i = outer; i < points.size(); ++i) {
      vertices.push_back(static_cast<std::uint32_t>(mesh_.vertices_nm.size()));
      Vec3 p;
      p.*u = points[i][0];
      p.*v = points[i][1];
      p.*w = a.*w - (n.*u * (p.*u - a.*u) + n.*v * (p.*v - a.*v)) / n.*w;
      mesh_.vertices_nm.push_back(p);
    }
    for (Triangle& t : filled)
      for (std::uint32_t& c : t) c = vertices[c];
  }

  void replace() {
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const std::uint32_t r = region_[i];
      if (!is_merged(r)) triangles.push_back(mesh_.triangles[i]);
      else if (first_of_[r] == i)
        triangles.insert(triangles.end(), filled_[r].begin(), filled_[r].end());
    }
    mesh_.triangles = std::move(triangles);
    drop_unused();
  }

  void drop_unused() {
    // Also drops vertices of regions that were filled twice.
    std::vector<std::uint32_t> number(mesh_.vertices_nm.size(), none);
    for (const Triangle& t : mesh_.triangles)
      for (const std::uint32_t v : t) number[v] = 0;
    std::uint32_t count = 0;
    for (std::size_t v = 0; v < number.size(); ++v) {
      if (number[v] == none) continue;
      mesh_.vertices_nm[count] = mesh_.vertices_nm[v];
      number[v] = count++;
    }
    mesh_.vertices_nm.resize(count);
    mesh_.vertices_nm.shrink_to_fit();
    for (Triangle& t : mesh_.triangles)
      for (std::uint32_t& v : t) v = number[v];
  }

  TriangleMesh& mesh_;
  double tolerance_;
  const Watch& watch_;
  std::vector<std::uint32_t> neighbours_;  // per side
  std::vector<std::uint32_t> region_;      // per triangle
  std::vector<std::uint32_t> first_of_;    // per region: its first triangle
  std::vector<std::uint32_t> size_of_;     // triangles; 1: left as it is
  std::vector<Vec3> normal_of_;
  std::vector<std::uint8_t> dropped_;          // per vertex
  std::vector<std::vector<Triangle>> filled_;  // per region
};

}  // namespace

TriangleMesh merge_coplanar(TriangleMesh mesh, const MergeCoplanarOptions& options) {
  require_not_negative(options.tolerance_nm, "tolerance");
  validate(mesh);
  CoplanarRegions(mesh, options).merge();
  return mesh;
}

}  // namespace surf
