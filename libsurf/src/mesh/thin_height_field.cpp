// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/thin_height_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <stdexcept>

#include "core/argument.h"
#include "mesh/lattice_delaunay.h"
#include "surf/core/error.h"
#include "surf/mesh/height_field_mesh.h"

namespace surf {
namespace {

constexpr int most_searches = 8;
constexpr double close_enough = 1.02;

std::int64_t floor_divided(std::int64_t a, std::int64_t b) {  // b > 0
  return a >= 0 ? a / b : -((-a + b - 1) / b);
}

/// Adds samples to a triangulation until it is within the tolerance.
class Thinning {
 public:
  Thinning(const HeightField& field, double tolerance_nm, std::size_t limit, const Watch& watch)
      : field_(field), tolerance_nm_(tolerance_nm), limit_(limit), watch_(watch),
        mesh_(field.z_nm.width(), field.z_nm.height()),
        used_(field.z_nm.width(), field.z_nm.height()) {
    for (const LatticePoint p : mesh_.points()) used_(p.x, p.y) = 1;
    changed_ = {0, 1};
    renew();
  }

  void run() {
    do {
      insert_worst_samples();
      mesh_.prefer_rising_diagonals();
    } while (insert_at_crossings());
  }

  TriangleMesh mesh() const {
    TriangleMesh out;
    out.vertices_nm.reserve(mesh_.points().size());
    for (const LatticePoint p : mesh_.points())
      out.vertices_nm.push_back({field_.x_nm(p.x), field_.y_nm(p.y), z(p)});
    out.triangles = mesh_.triangles();
    return out;
  }

  double deviation_nm() const { return std::max(crossing_nm_, sample_deviation_nm()); }

  /// The deviation at samples only.
  double sample_deviation_nm() const {
    double largest = 0;
    for (const Worst& w : worst_) largest = std::max(largest, w.error_nm);
    return largest;
  }

 private:
  // The sample of a triangle with the largest deviation from it.
  struct Worst {
    double error_nm = 0;
    LatticePoint at;
  };
  // Triangles change while they wait in the queue. An entry is outdated if its error differs from
  // the triangle's.
  struct Waiting {
    double error_nm;
    std::uint32_t triangle;
    bool operator<(const Waiting& b) const {
      return error_nm != b.error_nm ? error_nm < b.error_nm : triangle > b.triangle;
    }
  };

  double z(LatticePoint p) const { return field_.z_nm(p.x, p.y); }

  Worst worst_of(std::uint32_t triangle) const {
    const LatticePoint a = mesh_.corner(triangle, 0), b = mesh_.corner(triangle, 1),
                       c = mesh_.corner(triangle, 2);
    const auto area = static_cast<double>(doubled_area(a, b, c));
    const double ab = z(b) - z(a), ac = z(c) - z(a);
    const double slope_x = (ab * (c.y - a.y) - ac * (b.y - a.y)) / area;
    const double slope_y = (ac * (b.x - a.x) - ab * (c.x - a.x)) / area;
    const auto [least_x, most_x] = std::minmax({a.x, b.x, c.x});
    const auto [least_y, most_y] = std::minmax({a.y, b.y, c.y});
    Worst worst;
    for (std::int32_t y = least_y; y <= most_y; ++y) {
      // The part of the row that lies to the left of all sides: u x + v >= 0, in integers.
      std::int64_t from = least_x, to = most_x;
      for (const auto& [p, q] : {std::pair{a, b}, {b, c}, {c, a}}) {
        const std::int64_t u = std::int64_t{p.y} - q.y;
        const std::int64_t v = (std::int64_t{q.x} - p.x) * (std::int64_t{y} - p.y) - u * p.x;
        if (u > 0) from = std::max(from, -floor_divided(v, u));
        else if (u < 0) to = std::min(to, floor_divided(v, -u));
        else if (v < 0) to = from - 1;
      }
      const double row = z(a) + slope_y * (y - a.y);
      for (auto x = static_cast<std::int32_t>(from); x <= to; ++x) {
        const double error = std::abs(row + slope_x * (x - a.x) - field_.z_nm(x, y));
        if (error > worst.error_nm && !used_(x, y)) worst = {error, {x, y}};
      }
    }
    return worst;
  }

  void renew() {
    std::ranges::sort(changed_);
    changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
    worst_.resize(mesh_.triangles().size());
    if (worst_.size() < few) watch_.check();  // triangles are still large and take long
    for (const std::uint32_t t : changed_) {
      worst_[t] = worst_of(t);
      if (worst_[t].error_nm > tolerance_nm_) waiting_.push({worst_[t].error_nm, t});
    }
    changed_.clear();
  }

  static constexpr std::uint32_t few = 4096;

  // A sample inside a triangle adds two triangles.
  bool full() const { return mesh_.triangles().size() + 2 > limit_; }

  void insert(LatticePoint p, std::uint32_t triangle) {
    used_(p.x, p.y) = 1;
    mesh_.insert(p, triangle, changed_);
    renew();
  }

  // The number of triangles is roughly proportional to 1 / error.
  void report(double error_nm) const {
    if (mesh_.triangles().size() % 1024 > 1) return;
    const double by_number =
        static_cast<double>(mesh_.triangles().size()) / static_cast<double>(limit_);
    watch_.report(std::min(1.0, std::max(by_number, tolerance_nm_ / error_nm)), 1);
  }

  void insert_worst_samples() {
    while (!waiting_.empty() && !full()) {
      const Waiting next = waiting_.top();
      report(next.error_nm);
      waiting_.pop();
      const Worst& worst = worst_[next.triangle];
      if (worst.error_nm == next.error_nm && !used_(worst.at.x, worst.at.y))
        insert(worst.at, next.triangle);
    }
  }

  /// Calls visit(before, after, share, t) for each crossing of the line from p to q with a line
  /// between two neighbouring samples. The crossing is at `share` of the way from `before` to
  /// `after` and at `t` of the way from p to q.
  template <class Visit>
  static void visit_crossings(LatticePoint p, LatticePoint q, const Visit& visit) {
    const std::int64_t dx = std::int64_t{q.x} - p.x, dy = std::int64_t{q.y} - p.y;
    // Columns (x = k), rows (y = k) and the cells' diagonals (x - y = k).
    const struct {
      std::int64_t per, across;
      LatticePoint step;
      int kind;
    } families[] = {{dx, dy, {0, 1}, 0}, {dy, dx, {1, 0}, 1}, {dx - dy, dy, {1, 1}, 2}};
    for (const auto& f : families) {
      const std::int64_t count = std::abs(f.per), sign = f.per < 0 ? -1 : 1;
      for (std::int64_t i = 1; i < count; ++i) {
        // The i-th crossing is displaced from p by i * across / count.
        const std::int64_t moved = i * f.across, whole = floor_divided(moved, count);
        const std::int64_t rest = moved - whole * count;
        if (rest == 0) continue;  // at a sample
        LatticePoint before;
        if (f.kind == 0)
          before = {p.x + static_cast<std::int32_t>(sign * i),
                    p.y + static_cast<std::int32_t>(whole)};
        else if (f.kind == 1)
          before = {p.x + static_cast<std::int32_t>(whole),
                    p.y + static_cast<std::int32_t>(sign * i)};
        else
          before = {p.x + static_cast<std::int32_t>(whole + sign * i),
                    p.y + static_cast<std::int32_t>(whole)};
        visit(before, LatticePoint{before.x + f.step.x, before.y + f.step.y},
              static_cast<double>(rest) / static_cast<double>(count),
              static_cast<double>(i) / static_cast<double>(count));
      }
    }
  }

  // Adds a sample next to the worst crossing of every edge whose deviation exceeds the tolerance.
  // Returns false if there is none, or if no triangles are left.
  bool insert_at_crossings() {
    struct Site {
      LatticePoint at;
      std::uint32_t triangle;
    };
    std::vector<Site> sites;
    crossing_nm_ = 0;
    for (std::uint32_t side = 0; side < 3 * mesh_.triangles().size(); ++side) {
      if (side % few == 0) watch_.check();
      if (mesh_.opposite(side) != LatticeDelaunay::none && mesh_.opposite(side) < side) continue;
      const LatticePoint p = mesh_.corner(side / 3, side % 3),
                         q = mesh_.corner(side / 3, (side + 1) % 3);
      double worst = 0;
      LatticePoint at;
      visit_crossings(p, q, [&](LatticePoint before, LatticePoint after, double share, double t) {
        const double error =
            std::abs(std::lerp(z(before), z(after), share) - std::lerp(z(p), z(q), t));
        if (error <= worst) return;
        worst = error;
        at = used_(before.x, before.y) ? after : before;
      });
      crossing_nm_ = std::max(crossing_nm_, worst);
      if (worst > tolerance_nm_) sites.push_back({at, side / 3});
    }
    const std::size_t before = mesh_.points().size();
    if (full()) return false;
    for (const Site& s : sites)
      if (!used_(s.at.x, s.at.y) && !full()) insert(s.at, mesh_.find(s.at, s.triangle));
    if (!sites.empty() && mesh_.points().size() == before)
      throw std::logic_error("thin_height_field: a crossing has no sample to add");
    return !sites.empty();
  }

  const HeightField& field_;
  double tolerance_nm_;
  std::size_t limit_;  // of triangles
  const Watch& watch_;
  LatticeDelaunay mesh_;
  Mask used_;
  std::vector<Worst> worst_;  // of every triangle
  std::priority_queue<Waiting> waiting_;
  std::vector<std::uint32_t> changed_;
  double crossing_nm_ = 0;
};

struct Thinned {
  TriangleMesh mesh;
  double deviation_nm = 0, sample_deviation_nm = 0;
};

Thinned thin(const HeightField& field, double tolerance_nm, std::size_t limit, const Watch& watch) {
  Thinning thinning(field, tolerance_nm, limit, watch);
  thinning.run();
  return {thinning.mesh(), thinning.deviation_nm(), thinning.sample_deviation_nm()};
}

/// The best approximation with a limited number of triangles. A single pass would serve the samples
/// first and leave the crossings of edges with large deviations, so the smallest feasible tolerance
/// is searched.
Thinned thin_to_limit(const HeightField& field, const ThinOptions& o) {
  Thinned best = thin(field, o.tolerance_nm, o.triangles, o.watch.part(0, 0.3));
  double low = std::max(o.tolerance_nm, best.sample_deviation_nm);
  for (int step = 0; step < most_searches && best.deviation_nm > close_enough * low; ++step) {
    const double tolerance = low > 0 ? std::sqrt(low * best.deviation_nm) : best.deviation_nm / 4;
    const double share = 0.7 / most_searches;
    Thinned here = thin(field, tolerance, o.triangles,
                        o.watch.part(0.3 + share * step, 0.3 + share * (step + 1)));
    if (here.deviation_nm > tolerance) low = tolerance;
    if (here.deviation_nm < best.deviation_nm) best = std::move(here);
  }
  return best;
}

}  // namespace

ThinSheet thin_height_field(const HeightField& field, const ThinOptions& options) {
  require_not_negative(options.tolerance_nm, "tolerance");
  if (options.triangles == 1)
    throw UsageError("triangles", "one triangle does not fill a rectangle", "Give 2 or more");
  require_no_holes(field);
  Thinned thinned = options.triangles
                        ? thin_to_limit(field, options)
                        : thin(field, options.tolerance_nm, std::numeric_limits<std::size_t>::max(),
                               options.watch);
  ThinSummary summary;
  summary.triangles_before = std::size_t{2} * static_cast<std::size_t>(field.z_nm.width() - 1) *
                             static_cast<std::size_t>(field.z_nm.height() - 1);
  summary.triangles_after = thinned.mesh.triangles.size();
  summary.deviation_nm = thinned.deviation_nm;
  summary.reached = summary.deviation_nm <= options.tolerance_nm;
  return {std::move(thinned.mesh), summary};
}

}  // namespace surf
