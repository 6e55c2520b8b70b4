// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/distance_grid.h"

#include <cmath>

#include "geometry/local_triangles.h"
#include "geometry/nearest_triangle.h"
#include "surf/core/parallel.h"

namespace surf::mc {

namespace {

constexpr double steps = 32767;
constexpr double half_diagonal = 0.8660254037844388 * (1 + 1e-6);  // of a cube of edge 1
// Positions are good to this: hits lie on triangles up to rounding.
constexpr double slack_nm = 1e-3;
// Farther surfaces than this many edges count as being so far.
constexpr double brick_span = 26, cell_span = 16;
constexpr double smallest_cell_nm = 0.75;
constexpr double near_nm = 3;           // bricks farther from a surface are not cut,
constexpr double flat_nm = 0.05;        // nor those that fall no shorter than this
constexpr double flat_share = 0.15;     // and this share of their distance
constexpr double slab_edges = 2.5;      // surfaces farther than this many edges get no slab
constexpr double most_in_brick = 1500;  // nor bricks where more triangles would be looked at
constexpr double small_edges = 0.75;    // triangles up to this many edges stand as their corners
constexpr std::size_t most_bricks = std::size_t{1} << 21;
// More cells than this would take longer to fill than a coarse surface is worth.
constexpr double few_cells = 3e5, cells_per_triangle = 1.5, most_cells = 4e5;

// A polygon's part on one side of a plane across an axis.
std::vector<Vec3> clipped(const std::vector<Vec3>& polygon, double Vec3::*axis, double limit,
                          double sign) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double from = sign * (limit - a.*axis), to = sign * (limit - b.*axis);
    if (from >= 0) out.push_back(a);
    if ((from < 0) != (to < 0)) out.push_back(a + (b - a) * (from / (from - to)));
  }
  return out;
}

// The mesh's area within the box.
double area_within(const MeshView& mesh, const Box& box) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    std::vector<Vec3> part;
    bool inside = true, outside = false;
    for (const std::uint32_t v : t) part.push_back(mesh.vertices_nm[v]);
    for (double Vec3::*x : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      const double low = std::min({part[0].*x, part[1].*x, part[2].*x}),
                   high = std::max({part[0].*x, part[1].*x, part[2].*x});
      inside = inside && low >= box.lower_nm.*x && high <= box.upper_nm.*x;
      outside = outside || high < box.lower_nm.*x || low > box.upper_nm.*x;
    }
    if (outside) continue;
    if (!inside)
      for (double Vec3::*x : {&Vec3::x, &Vec3::y, &Vec3::z})
        part = clipped(clipped(part, x, box.upper_nm.*x, 1), x, box.lower_nm.*x, -1);
    Vec3 across;
    for (std::size_t i = 2; i < part.size(); ++i)
      across += cross(part[i - 1] - part[0], part[i] - part[0]);
    sum += 0.5 * length(across);
  }
  return sum;
}

}  // namespace

class DistanceGridBuilder {
 public:
  using Cell = DistanceGrid::Cell;

  DistanceGridBuilder(const MeshView& mesh, const Box& domain, std::size_t bytes, int threads,
                      const Watch& watch, DistanceGrid& field)
      : watch_{{}, watch.cancel}, field_(field), domain_(domain), bytes_(bytes), threads_(threads),
        most_cells_(std::min(
            {static_cast<double>(bytes) / sizeof(Cell), most_cells,
             few_cells + cells_per_triangle * static_cast<double>(mesh.triangles.size())})),
        area_(area_within(mesh, domain)), cell_(first_cell(area_)), widest_(1.5 * cell_),
        tree_(mesh, grown(domain, (brick_span + 4) * DistanceGrid::cut * widest_), watch_, threads),
        per_area_(static_cast<double>(tree_.size()) / std::max(area_, 1e-9)) {}

  void build() {
    for (;;) {
      lay_out();
      std::vector<std::uint32_t> cut = fill_bricks();
      const double excess =
          static_cast<double>((bricks_.size() + cut.size() * in_brick) * sizeof(Cell)) /
          static_cast<double>(bytes_);
      if (excess <= 1 || cell_ >= widest_) {
        // At worst the last bricks stay whole, to be within the memory.
        cut.resize(std::min(cut.size(), bytes_ / sizeof(Cell) / in_brick));
        fill_cells(cut);
        return;
      }
      cell_ = std::min(widest_, 1.05 * cell_ * std::cbrt(excess));
    }
  }

 private:
  static constexpr std::size_t in_brick = DistanceGrid::cut * DistanceGrid::cut * DistanceGrid::cut;

  struct Fit {
    Cell cell;
    double shortfall_nm;  // at the centre; the slab's thickness where the surface is in the cell
    double floor_nm;
  };

  static Box grown(Box box, double by) {
    box.lower_nm -= Vec3{by, by, by};
    box.upper_nm += Vec3{by, by, by};
    return box;
  }

  double first_cell(double area) const {
    const Vec3 size = domain_.size_nm();
    double h = smallest_cell_nm;
    for (;; h *= 1.05) {
      const double brick = DistanceGrid::cut * h;
      const double bricks = (size.x / brick + 4) * (size.y / brick + 4) * (size.z / brick + 4);
      const double cells = area * 2 * (near_nm + 0.5 * brick) / (h * h * h);
      if (bricks <= most_bricks &&
          1.25 * bricks + std::min(cells, bricks * in_brick) <= most_cells_)
        return h;
      if (bricks <= 65) return h;  // as few as can be
    }
  }

  void lay_out() {
    edge_ = DistanceGrid::cut * cell_;
    const Box box = grown(domain_, 2 * edge_);
    const Vec3 size = box.size_nm();
    field_.lower_ = box.lower_nm;
    field_.bricks_per_nm_ = 1 / edge_;
    field_.nx_ = static_cast<int>(size.x / edge_) + 1;
    field_.ny_ = static_cast<int>(size.y / edge_) + 1;
    field_.nz_ = static_cast<int>(size.z / edge_) + 1;
    field_.levels_ = {level(1, brick_span), level(DistanceGrid::cut, cell_span)};
    field_.cell_nm_ = cell_;
  }

  DistanceGrid::Level level(int cells, double span) const {
    const double unit = span * edge_ / cells / steps, r = half_diagonal * steps / span;
    DistanceGrid::Level out;
    out.cells = static_cast<float>(cells);
    out.last = cells - 1;
    out.scale = static_cast<float>(1 / span);
    out.unit_nm = static_cast<float>(unit * (1 - 1e-6));
    out.beyond = static_cast<float>(std::floor(r));
    out.inside = static_cast<float>(std::ceil(r));
    return out;
  }

  Vec3 brick_lower(int x, int y, int z) const {
    return field_.lower_ + Vec3{double(x), double(y), double(z)} * edge_;
  }

  std::vector<LocalTriangles> lists() const {
    return std::vector<LocalTriangles>(static_cast<std::size_t>(threads_), LocalTriangles(tree_));
  }

  // All bricks whole; the answer are those worth cutting.
  std::vector<std::uint32_t> fill_bricks() {
    bricks_.assign(field_.index(0, 0, field_.nz_), {});
    std::vector<std::uint8_t> wanted(bricks_.size(), 0);
    const auto ny = static_cast<std::size_t>(field_.ny_);
    std::vector<LocalTriangles> surface = lists();
    parallel_for(
        static_cast<std::size_t>(field_.nz_) * ny, threads_,
        [&](std::size_t row, int worker) {
          const int y = static_cast<int>(row % ny), z = static_cast<int>(row / ny);
          std::uint32_t guess = TriangleTree::none;
          for (int x = 0; x < field_.nx_; ++x) {
            const Vec3 center = brick_lower(x, y, z) + Vec3{0.5, 0.5, 0.5} * edge_;
            const Fit fit = brick(center, surface[static_cast<std::size_t>(worker)], guess);
            const std::size_t i = field_.index(x, y, z);
            bricks_[i] = fit.cell;
            wanted[i] =
                fit.floor_nm < near_nm && fit.shortfall_nm > flat_nm + flat_share * fit.floor_nm;
          }
        },
        watch_);
    std::vector<std::uint32_t> cut;
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (wanted[i]) cut.push_back(static_cast<std::uint32_t>(i));
    return cut;
  }

  void fill_cells(const std::vector<std::uint32_t>& cut) {
    field_.bricks_.assign(bricks_.size(), 0);
    for (const std::uint32_t i : cut) field_.bricks_[i] = DistanceGrid::is_cut;
    std::vector<Cell>& cells = field_.cells_;
    cells.reserve(bricks_.size() + cut.size() * (in_brick - 1));
    for (std::size_t i = 0; i < bricks_.size(); ++i) {
      const auto at = static_cast<std::uint32_t>(cells.size());
      if (field_.bricks_[i] == 0) {
        // Far away many neighbours are alike.
        const bool alike = i > 0 && !(field_.bricks_[i - 1] & DistanceGrid::is_cut) &&
                           same(bricks_[i], bricks_[i - 1]);
        if (!alike) cells.push_back(bricks_[i]);
        field_.bricks_[i] = alike ? at - 1 : at;
      } else {
        field_.bricks_[i] = at | DistanceGrid::is_cut;
        cells.resize(cells.size() + in_brick);
      }
    }
    bricks_ = {};
    const auto nx = static_cast<std::uint32_t>(field_.nx_),
               ny = static_cast<std::uint32_t>(field_.ny_);
    constexpr std::size_t block = 16;
    std::vector<LocalTriangles> surface = lists();
    parallel_for(
        (cut.size() + block - 1) / block, threads_,
        [&](std::size_t b, int worker) {
          for (std::size_t k = b * block; k < std::min(cut.size(), (b + 1) * block); ++k) {
            const std::uint32_t i = cut[k];
            const Vec3 lower = brick_lower(static_cast<int>(i % nx), static_cast<int>(i / nx % ny),
                                           static_cast<int>(i / nx / ny));
            fill(lower + Vec3{0.5, 0.5, 0.5} * edge_, surface[static_cast<std::size_t>(worker)],
                 &cells[field_.bricks_[i] & ~DistanceGrid::is_cut]);
          }
        },
        watch_);
  }

  // The cells of a brick, by way of its eighths. Cells that are not near the surface get no slab
  // and need to know little of it.
  void fill(const Vec3& center, LocalTriangles& surface, Cell* out) const {
    const auto corner = [](int i) {
      return Vec3{i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5};
    };
    const double r = half_diagonal * cell_, asked = slab_within(cell_) + 2 * r + 3 * slack_nm;
    NearestTriangle nearest;
    improve(tree_, center, nearest);
    const double all_covered = std::min(nearest.distance + 8 * r + 4 * slack_nm, asked + 3 * r);
    surface.collect(center, all_covered, small_edges * cell_);
    LocalTriangles::Part part;
    for (int e = 0; e < 8; ++e) {
      const Vec3 middle = corner(e) * (0.5 * edge_);
      const double part_covered = std::min(all_covered - length(middle), asked + r);
      const double part_distance =
          std::max(nearest.distance - length(middle),
                   std::min(surface.nearest(surface.all(), middle).distance, part_covered));
      const bool is_far = part_distance - r >= slab_within(cell_);
      if (!is_far) surface.narrow(surface.all(), middle, part_covered, part);
      for (int c = 0; c < 8; ++c) {
        const Vec3 offset = corner(c) * cell_;
        const int x = 2 * (e & 1) + (c & 1), y = (e & 2) + (c >> 1 & 1),
                  z = (e >> 1 & 2) + (c >> 2);
        const double at_least = std::max(0.0, part_distance - length(offset));
        out[(z * DistanceGrid::cut + y) * DistanceGrid::cut + x] =
            (is_far ? without_slab(at_least, cell_, cell_span)
                    : fitted(surface, part, middle + offset, at_least,
                             part_covered - length(offset), cell_, cell_span))
                .cell;
      }
    }
  }

  // `guess`: a triangle that is near, or none; left as the nearest.
  Fit brick(const Vec3& center, LocalTriangles& surface, std::uint32_t& guess) const {
    const double r = half_diagonal * edge_;
    NearestTriangle nearest{brick_span * edge_, TriangleTree::none, {}};
    if (guess != TriangleTree::none) improve(tree_, center, guess, nearest);
    improve(tree_, center, nearest);
    guess = nearest.triangle;
    const double d = nearest.distance, covered = d + 2 * r + 4 * slack_nm;
    const double in_ball = std::min(static_cast<double>(tree_.size()),
                                    per_area_ * 3.14159265 * (covered * covered - d * d));
    if (d >= slab_within(edge_) || in_ball > most_in_brick)
      return without_slab(d, edge_, brick_span);
    surface.collect(center, covered, small_edges * edge_);
    return fitted(surface, surface.all(), {}, d, covered, edge_, brick_span);
  }

  static bool same(const Cell& a, const Cell& b) {
    return a.n == b.n && a.low == b.low && a.high == b.high && a.distance == b.distance;
  }

  static double slab_within(double edge) { return std::max(near_nm, slab_edges * edge); }

  static Fit without_slab(double distance, double edge, double span) {
    const double r = half_diagonal * edge;
    Fit fit;
    fit.floor_nm = std::max(0.0, distance - r);
    fit.shortfall_nm = r;
    fit.cell = {};
    fit.cell.distance = down((distance - slack_nm) * steps / (span * edge));
    fit.cell.low = -32768;  // everywhere: the floor is the bound
    fit.cell.high = 32767;
    return fit;
  }

  // For the cell around `center`, from a part of the surface that holds all within `covered` of it;
  // nothing is nearer than `at_least`.
  Fit fitted(LocalTriangles& surface, const LocalTriangles::Part& part, const Vec3& center,
             double at_least, double covered, double edge, double span) const {
    const double unit = span * edge / steps, r = half_diagonal * edge;
    const LocalTriangles::Nearest nearest = surface.nearest(part, center);
    const double d = std::max(at_least, std::min(nearest.distance, covered));
    Fit fit = without_slab(std::min(d, span * edge), edge, span);
    const double radius = std::min(d + 2 * r + 2 * slack_nm, covered);
    if (d >= slab_within(edge) || radius < 2 * r + slack_nm) return fit;
    const Cell base = fit.cell;
    surface.look_at(part, center, radius);

    double best = -1;
    const auto try_normal = [&](const Vec3& n) {
      const double size = length(n);
      if (!(size > 0)) return;
      Cell cell = with_slab(base, surface, n * (1 / size), unit);
      cell.distance = down((radius - 2 * r - slack_nm) / unit);
      const double sum = mean_bound(cell, edge == edge_ ? field_.levels_[0] : field_.levels_[1]);
      if (sum <= best) return;
      best = sum;
      fit.cell = cell;
    };
    // A thin slab cannot be bettered by much.
    const auto is_thin = [&] {
      return best >= 0 && fit.cell.high - fit.cell.low < 0.1 * edge / unit;
    };
    try_normal(nearest.away);
    if (d < r && !is_thin()) try_normal(surface.mean_normal());
    if (best < 0) try_normal({0, 0, 1});
    const double middle = std::max<double>(-fit.cell.high, fit.cell.low);
    fit.shortfall_nm = unit * (d > r ? d / unit - middle : double(fit.cell.high) - fit.cell.low);
    return fit;
  }

  static std::uint16_t down(double v) {
    return static_cast<std::uint16_t>(std::clamp(std::floor(v), 0.0, steps));
  }

  static Cell with_slab(Cell cell, LocalTriangles& surface, const Vec3& n, double unit) {
    // Towards zero: no longer than 1, so gaps do not come out too large.
    const double quantised[3] = {std::trunc(n.x * steps), std::trunc(n.y * steps),
                                 std::trunc(n.z * steps)};
    for (std::size_t k = 0; k < 3; ++k) cell.n[k] = static_cast<std::int16_t>(quantised[k]);
    const Vec3 used = Vec3{quantised[0], quantised[1], quantised[2]} * (1 / steps);
    const LocalTriangles::Slab slab = surface.slab(used);
    // Rounding of single precision in units, besides that of positions in nm.
    const double slack = slack_nm / unit + 0.05;
    const auto clamped = [](double v) {
      return static_cast<std::int16_t>(std::clamp(v, -32768.0, steps));
    };
    cell.low = 32767;  // nowhere
    cell.high = -32768;
    if (slab.low <= slab.high) {
      cell.low = clamped(std::floor(slab.low / unit - slack));
      cell.high = clamped(std::ceil(slab.high / unit + slack));
    }
    return cell;
  }

  static double mean_bound(const Cell& cell, const DistanceGrid::Level& level) {
    double sum = 0;
    for (int i = 0; i < 8; ++i)
      sum += DistanceGrid::bound(cell, i & 1 ? 0.9f : 0.1f, i & 2 ? 0.9f : 0.1f,
                                 i & 4 ? 0.9f : 0.1f, level);
    return sum;
  }

  const Watch watch_;  // tells nobody; first: the tree below is built with it
  DistanceGrid& field_;
  Box domain_;
  std::size_t bytes_;
  int threads_;
  double most_cells_;
  double area_;
  double cell_;
  double widest_;  // that the tree allows for
  TriangleTree tree_;
  double per_area_;  // triangles per nm^2
  double edge_ = 0;
  std::vector<Cell> bricks_;
};

DistanceGrid::DistanceGrid(const MeshView& mesh, const Box& domain, std::size_t bytes, int threads,
                           const Watch& watch)
    : surface_box_(bounds(mesh)) {
  if (mesh.triangles.empty() || bytes < 4096 || domain.empty()) return;
  DistanceGridBuilder(mesh, domain, bytes, resolve_threads(threads), watch, *this).build();
}

double DistanceGrid::outside_nm(const Vec3& p) const {
  const double above = p.z - surface_box_.upper_nm.z, below = surface_box_.lower_nm.z - p.z;
  const double dz = std::max({above, below, 0.0});
  const double dx = std::max({surface_box_.lower_nm.x - p.x, p.x - surface_box_.upper_nm.x, 0.0});
  const double dy = std::max({surface_box_.lower_nm.y - p.y, p.y - surface_box_.upper_nm.y, 0.0});
  const double gap = dx == 0 && dy == 0 ? dz : std::sqrt(dx * dx + dy * dy + dz * dz);
  return std::max(0.0, gap - slack_nm);
}

}  // namespace surf::mc
