// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/transport/energy_deposit.h"

#include <algorithm>
#include <cmath>

#include "geometry/scene_impl.h"
#include "surf/core/error.h"

namespace surf::mc {

namespace {

constexpr double most_cells = 1 << 28;

double& along(Vec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
double along(const Vec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

// How far electrons of the scene's beam get in any of its materials.
double reach_nm(const Scene::Impl& scene) {
  double reach = 0;
  for (const Medium& m : scene.media)
    reach = std::max(reach, m.range_nm(scene.beam.energy_ev + m.barrier_ev()));
  return std::min(reach, 1e9);
}

}  // namespace

DepositGrid deposit_grid(const Scene& scene, int cells_across) {
  if (cells_across < 1)
    throw UsageError("deposit grid", "it needs at least one cell", "Ask for 64, say");
  const Scene::Impl& s = scene.impl();
  const Scan& scan = s.scan;
  // Electrons turn on their way: two thirds of the range hold all but a trace of the energy.
  const double reach = reach_nm(s) * 2 / 3;
  const double half_x = 0.5 * scan.width * scan.pixel_x_nm + reach;
  const double half_y = 0.5 * scan.height * scan.pixel_y_nm + reach;
  DepositGrid grid;
  grid.box_nm.extend(Vec3{scan.center_x_nm - half_x, scan.center_y_nm - half_y,
                          s.bottom_nm - (s.half_space ? reach : 0)});
  grid.box_nm.extend(Vec3{scan.center_x_nm + half_x, scan.center_y_nm + half_y, s.top_nm});
  const Vec3 size = grid.box_nm.size_nm();
  const double edge = std::max({size.x, size.y, size.z}) / cells_across;
  for (int a = 0; a < 3; ++a) {
    const double n = std::max(1.0, std::ceil(along(size, a) / edge - 1e-9));
    grid.cells[static_cast<std::size_t>(a)] = static_cast<int>(n);
    // Whole cubes: the rest goes down and to both sides.
    const double extra = n * edge - along(size, a);
    along(grid.box_nm.lower_nm, a) -= a == 2 ? extra : extra / 2;
    along(grid.box_nm.upper_nm, a) += a == 2 ? 0 : extra / 2;
  }
  return grid;
}

EnergyDeposit::EnergyDeposit(const DepositGrid& grid) : grid_(grid) {
  const auto& n = grid.cells;
  const Vec3 size = grid.box_nm.size_nm();
  if (grid.box_nm.empty() || !(size.x > 0 && size.y > 0 && size.z > 0) ||
      std::min({n[0], n[1], n[2]}) < 1 || static_cast<double>(n[0]) * n[1] * n[2] > most_cells)
    throw UsageError("deposit grid", "it is empty, or has more than 2^28 cells",
                     "Give a box with a volume and at least one cell each way");
  cell_nm_ = {size.x / n[0], size.y / n[1], size.z / n[2]};
  sums_.resize(static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) *
                   static_cast<std::size_t>(n[2]) +
               1);
}

std::size_t EnergyDeposit::index(const std::array<int, 3>& c) const {
  for (std::size_t a = 0; a < 3; ++a)
    if (c[a] < 0 || c[a] >= grid_.cells[a]) return sums_.size() - 1;
  return static_cast<std::size_t>(c[0]) +
         static_cast<std::size_t>(grid_.cells[0]) *
             (static_cast<std::size_t>(c[1]) +
              static_cast<std::size_t>(grid_.cells[1]) * static_cast<std::size_t>(c[2]));
}

// From wall to wall of the cells (Amanatides and Woo, Eurographics 1987). Outside the grid cells go
// on as far as whole numbers are safe; pieces that start or end beyond that are outside as a whole.
void EnergyDeposit::deposit(const Vec3& from, const Vec3& to, double energy_ev) {
  if (energy_ev == 0) return;
  std::array<int, 3> cell{}, last{};
  for (int a = 0; a < 3; ++a) {
    const double origin = along(grid_.box_nm.lower_nm, a), edge = along(cell_nm_, a);
    const double n = grid_.cells[static_cast<std::size_t>(a)];
    const double u = (along(from, a) - origin) / edge, v = (along(to, a) - origin) / edge;
    if ((u < 0 && v < 0) || (u >= n && v >= n) || std::fabs(u) > 1e6 + n ||
        std::fabs(v) > 1e6 + n) {
      sums_.back().add(energy_ev);
      return;
    }
    cell[static_cast<std::size_t>(a)] = static_cast<int>(std::floor(u));
    last[static_cast<std::size_t>(a)] = static_cast<int>(std::floor(v));
  }
  if (cell == last) {
    sums_[index(cell)].add(energy_ev);
    return;
  }
  const Vec3 way = to - from;
  double t = 0, spent = 0;
  while (cell != last) {
    int axis = 0;
    double next = HUGE_VAL;
    for (int a = 0; a < 3; ++a) {
      const auto i = static_cast<std::size_t>(a);
      if (cell[i] == last[i]) continue;
      const bool up = last[i] > cell[i];
      const double wall =
          along(grid_.box_nm.lower_nm, a) + (cell[i] + (up ? 1 : 0)) * along(cell_nm_, a);
      const double at_wall = (wall - along(from, a)) / along(way, a);
      if (at_wall < next) {
        next = at_wall;
        axis = a;
      }
    }
    next = std::clamp(next, t, 1.0);
    const double share = (next - t) * energy_ev;
    sums_[index(cell)].add(share);
    spent += share;
    t = next;
    const auto i = static_cast<std::size_t>(axis);
    cell[i] += last[i] > cell[i] ? 1 : -1;
  }
  sums_[index(last)].add(energy_ev - spent);
}

EnergyDeposit& EnergyDeposit::operator+=(const EnergyDeposit& b) {
  for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += b.sums_[i];
  return *this;
}

const EnergySum& EnergyDeposit::cell(int i, int j, int k) const { return sums_[index({i, j, k})]; }

Volume EnergyDeposit::density(std::int64_t primaries) const {
  Volume v;
  v.name = "deposited_energy_density";
  v.unit = "eV/nm^3";
  v.cells = grid_.cells;
  v.lower_nm = grid_.box_nm.lower_nm;
  v.cell_nm = cell_nm_;
  const double n = static_cast<double>(std::max<std::int64_t>(1, primaries));
  const double scale = 1 / (cell_nm_.x * cell_nm_.y * cell_nm_.z * n);
  v.values.reserve(v.size());
  for (std::size_t i = 0; i < v.size(); ++i) v.values.push_back(sums_[i].ev() * scale);
  return v;
}

}  // namespace surf::mc
