// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "surf/core/volume.h"
#include "surf/mc/geometry/scene.h"
#include "surf/mc/transport/observer.h"
#include "surf/mc/transport/tally.h"

namespace surf::mc {

/// A regular grid of cells in space.
struct DepositGrid {
  Box box_nm;
  std::array<int, 3> cells{64, 64, 64};  ///< along x, y, z; each >= 1, at most 2^28 in all
};

/// The grid that holds what a scene's beam leaves behind: the scan and, around and below it, as far
/// as its electrons reach, in cubes, `cells_across` (>= 1) along the longest side.
DepositGrid deposit_grid(const Scene& scene, int cells_across = 64);

/// Sums the energy that electrons leave in each cell. A straight piece's energy is shared among the
/// cells it runs through by length. What falls outside the grid is kept as one sum. Energies are
/// whole multiples of 2^-16 eV: grids of several threads add up to the same in any order.
class EnergyDeposit final : public Observer {
 public:
  explicit EnergyDeposit(const DepositGrid& grid);  ///< throws UsageError on an empty grid

  void deposit(const Vec3& from_nm, const Vec3& to_nm, double energy_ev) override;
  EnergyDeposit& operator+=(const EnergyDeposit& other);  ///< of the same grid

  const EnergySum& cell(int i, int j, int k) const;
  const EnergySum& outside() const { return sums_.back(); }

  /// Energy density in eV per nm^3 and primary.
  Volume density(std::int64_t primaries) const;

 private:
  std::size_t index(const std::array<int, 3>& cell) const;

  DepositGrid grid_;
  Vec3 cell_nm_;
  std::vector<EnergySum> sums_;  // of the cells, then of all outside
};

}  // namespace surf::mc
