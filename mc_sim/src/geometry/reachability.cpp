// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/reachability.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "surf/core/triangle_geometry.h"

namespace surf::mc {

namespace {

constexpr double most_boxes = 1 << 18;
constexpr double most_touched = 3e8;   // boxes of triangles; more is not worth the time
constexpr double most_angles = 5e7;    // solid angles of triangles, likewise
constexpr double inside_turns = 0.25;  // a closed shell is seen under 1 or 0, a sheet under +-0.5

// The solid angle of a triangle seen from 0, over 4 pi.
double turns(const Vec3& a, const Vec3& b, const Vec3& c) {
  return half_solid_angle(a, b, c) / (2 * 3.14159265358979324);
}

class Boxes {
 public:
  Boxes(const MeshView& mesh, const Box& domain) : mesh_(mesh) {
    const Vec3 size = domain.size_nm();
    const double longest = std::max({size.x, size.y, size.z, 1e-3});
    edge_ = std::max(std::cbrt(size.x * size.y * size.z / most_boxes), longest / 256);
    lower_ = domain.lower_nm - Vec3{edge_, edge_, edge_};
    const double whole[] = {size.x, size.y, size.z};
    for (int k = 0; k < 3; ++k) n_[k] = static_cast<int>(whole[k] / edge_) + 3;
    state_.assign(static_cast<std::size_t>(n_[0]) * static_cast<std::size_t>(n_[1]) *
                      static_cast<std::size_t>(n_[2]),
                  0);
  }

  // Marks what triangles touch; false where that would take too long.
  bool touch() {
    double work = 0;
    for (const Triangle& t : mesh_.triangles) {
      Range r;
      range(t, r);
      work += r.count();
      if (work > most_touched) return false;
      for_each(r, [&](std::size_t i) { state_[i] |= touched; });
    }
    return true;
  }

  // Marks what is matter, region by region of boxes that nothing touches.
  void find_matter(std::span<const std::uint32_t> shell_of, const std::vector<Shell>& shells,
                   std::optional<double> plane, const Watch& watch) {
    std::vector<std::vector<std::size_t>> regions;
    for (std::size_t i = 0; i < state_.size(); ++i)
      if (!(state_[i] & (touched | seen))) regions.push_back(region(i));
    std::sort(regions.begin(), regions.end(), [](const auto& a, const auto& b) {
      return a.size() > b.size() || (a.size() == b.size() && a[0] < b[0]);
    });
    const double affordable = most_angles / static_cast<double>(mesh_.triangles.size());
    for (std::size_t k = 0;
         k < regions.size() && static_cast<double>(k) < std::max(affordable, 2.0); ++k) {
      watch.check();
      if (is_matter(middle(regions[k][0]), shell_of, shells))
        for (const std::size_t i : regions[k]) state_[i] |= matter;
    }
    if (!plane) return;
    for (int z = 0; z < n_[2]; ++z)
      if (lower_.z + (z + 1) * edge_ <= *plane)
        for (int y = 0; y < n_[1]; ++y)
          for (int x = 0; x < n_[0]; ++x) state_[index(x, y, z)] |= matter;
  }

  // Marks what is not matter and hangs together with the rim, over corners too.
  void flood() {
    std::vector<std::size_t> waiting;
    const auto reach = [&](int x, int y, int z) {
      std::uint8_t& s = state_[index(x, y, z)];
      if (s & (matter | reached)) return;
      s |= reached;
      waiting.push_back(index(x, y, z));
    };
    for (int z = 0; z < n_[2]; ++z)
      for (int y = 0; y < n_[1]; ++y)
        for (int x = 0; x < n_[0]; ++x)
          if (x == 0 || y == 0 || z == 0 || x == n_[0] - 1 || y == n_[1] - 1 || z == n_[2] - 1)
            reach(x, y, z);
    while (!waiting.empty()) {
      int at[3];
      place(waiting.back(), at);
      waiting.pop_back();
      for (int z = std::max(at[2] - 1, 0); z <= std::min(at[2] + 1, n_[2] - 1); ++z)
        for (int y = std::max(at[1] - 1, 0); y <= std::min(at[1] + 1, n_[1] - 1); ++y)
          for (int x = std::max(at[0] - 1, 0); x <= std::min(at[0] + 1, n_[0] - 1); ++x)
            reach(x, y, z);
    }
  }

  std::vector<std::uint8_t> within(double distance) const {
    const std::vector<float> squared = squared_gaps();
    const double limit = distance / edge_ * (distance / edge_) * (1 + 1e-6);
    std::vector<std::uint8_t> reachable;
    for (const Triangle& t : mesh_.triangles) {
      Range r;
      bool is_reachable = !range(t, r);
      for_each(r, [&](std::size_t i) {
        is_reachable = is_reachable || static_cast<double>(squared[i]) <= limit;
      });
      reachable.push_back(is_reachable);
    }
    return reachable;
  }

 private:
  static constexpr std::uint8_t touched = 1, seen = 2, matter = 4, reached = 8;

  struct Range {
    int first[3], last[3];
    double count() const {
      double n = 1;
      for (int k = 0; k < 3; ++k) n *= std::max(0, last[k] - first[k] + 1);
      return n;
    }
  };

  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(n_[1]) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(n_[0]) +
           static_cast<std::size_t>(x);
  }
  void place(std::size_t i, int (&at)[3]) const {
    const auto nx = static_cast<std::size_t>(n_[0]), ny = static_cast<std::size_t>(n_[1]);
    at[0] = static_cast<int>(i % nx);
    at[1] = static_cast<int>(i / nx % ny);
    at[2] = static_cast<int>(i / nx / ny);
  }
  Vec3 middle(std::size_t i) const {
    int at[3];
    place(i, at);
    return lower_ + Vec3{at[0] + 0.5, at[1] + 0.5, at[2] + 0.5} * edge_;
  }

  // The boxes that a triangle may touch; false where it reaches beyond them.
  bool range(const Triangle& t, Range& r) const {
    Box box;
    for (const std::uint32_t v : t) box.extend(mesh_.vertices_nm[v]);
    const Vec3 low = (box.lower_nm - lower_) * (1 / edge_),
               high = (box.upper_nm - lower_) * (1 / edge_);
    const double from[] = {low.x, low.y, low.z}, to[] = {high.x, high.y, high.z};
    bool within = true;
    constexpr double hair = 1e-6;
    for (int k = 0; k < 3; ++k) {
      within = within && from[k] >= 0 && to[k] <= n_[k];
      r.first[k] = static_cast<int>(std::clamp(std::floor(from[k] - hair), 0.0, double(n_[k])));
      r.last[k] = static_cast<int>(std::clamp(std::floor(to[k] + hair), -1.0, n_[k] - 1.0));
    }
    return within;
  }

  template <class Visit>
  void for_each(const Range& r, const Visit& visit) const {
    for (int z = r.first[2]; z <= r.last[2]; ++z)
      for (int y = r.first[1]; y <= r.last[1]; ++y)
        for (int x = r.first[0]; x <= r.last[0]; ++x) visit(index(x, y, z));
  }

  // The untouched boxes that hang together with one over faces.
  std::vector<std::size_t> region(std::size_t first) {
    std::vector<std::size_t> all{first};
    state_[first] |= seen;
    for (std::size_t k = 0; k < all.size(); ++k) {
      int at[3];
      place(all[k], at);
      for (int axis = 0; axis < 3; ++axis)
        for (const int step : {-1, 1}) {
          int to[3] = {at[0], at[1], at[2]};
          to[axis] += step;
          if (to[axis] < 0 || to[axis] >= n_[axis]) continue;
          const std::size_t i = index(to[0], to[1], to[2]);
          if (state_[i] & (touched | seen)) continue;
          state_[i] |= seen;
          all.push_back(i);
        }
    }
    return all;
  }

  // Whether a solid holds `p`: more of its outer shells than of its cavities are around it.
  bool is_matter(const Vec3& p, std::span<const std::uint32_t> shell_of,
                 const std::vector<Shell>& shells) const {
    std::vector<double> around(shells.size(), 0.0);
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const Triangle& t = mesh_.triangles[i];
      around[shell_of[i]] += turns(mesh_.vertices_nm[t[0]] - p, mesh_.vertices_nm[t[1]] - p,
                                   mesh_.vertices_nm[t[2]] - p);
    }
    std::map<int, int> depth;
    for (std::size_t s = 0; s < shells.size(); ++s)
      if (around[s] * shells[s].sense > inside_turns) depth[shells[s].solid] += shells[s].sense;
    return std::any_of(depth.begin(), depth.end(), [](const auto& d) { return d.second > 0; });
  }

  // The squares of the least distances of each box from a reached one, in edges.
  std::vector<float> squared_gaps() const {
    constexpr float far = 1e30f;
    std::vector<float> squared(state_.size());
    for (std::size_t i = 0; i < state_.size(); ++i) squared[i] = state_[i] & reached ? 0.0f : far;
    std::vector<float> line;
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t stride = axis == 0 ? 1 : axis == 1 ? index(0, 1, 0) : index(0, 0, 1);
      const auto n = static_cast<std::size_t>(n_[axis]);
      for (std::size_t i = 0; i < squared.size(); ++i) {
        if (i / stride % n != 0) continue;  // the first box of a line
        line.clear();
        for (std::size_t k = 0; k < n; ++k) line.push_back(squared[i + k * stride]);
        for (std::size_t k = 0; k < n; ++k) {
          float least = far;
          for (std::size_t m = 0; m < n; ++m) {
            const float gap = k == m ? 0.0f : static_cast<float>((k > m ? k - m : m - k) - 1);
            least = std::min(least, line[m] + gap * gap);
          }
          squared[i + k * stride] = least;
        }
      }
    }
    return squared;
  }

  const MeshView mesh_;
  double edge_ = 1;
  Vec3 lower_;
  int n_[3];
  std::vector<std::uint8_t> state_;
};

}  // namespace

std::vector<std::uint8_t> reachable_triangles(const MeshView& mesh,
                                              std::span<const std::uint32_t> shell_of,
                                              const std::vector<Shell>& shells,
                                              std::optional<double> plane_nm, const Box& domain,
                                              double reach_nm, const Watch& watch) {
  const std::vector<std::uint8_t> all(mesh.triangles.size(), 1);
  // One shell alone has nothing within it.
  if (shells.size() < 2 || domain.empty() || !std::isfinite(reach_nm)) return all;
  Boxes boxes(mesh, domain);
  if (!boxes.touch()) return all;
  watch.check();
  boxes.find_matter(shell_of, shells, plane_nm, watch);
  watch.check();
  boxes.flood();
  watch.check();
  return boxes.within(reach_nm);
}

}  // namespace surf::mc
