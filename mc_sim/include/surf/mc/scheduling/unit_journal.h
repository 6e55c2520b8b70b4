// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace surf::mc {

struct UnitTally;

/// What a simulation keeps of its finished units of work, so that it can go on later: a unit's
/// tally depends on scene, options and the unit's number alone, and tallies merge in any order.
///
/// `simulate` calls one method at a time, from any of its threads, and all workers may wait for it:
/// be quick. What a method throws ends the simulation.
class UnitJournal {
 public:
  virtual ~UnitJournal() = default;

  /// Whether this unit was done before; then `tally` is set. `simulate` calls it once for every
  /// unit, in the order of their numbers, before anybody simulates the unit.
  virtual bool recall(std::size_t unit, UnitTally& tally) = 0;

  /// Keeps a unit that has been simulated. It is not called for units that were recalled.
  virtual void record(std::size_t unit, const UnitTally& tally) = 0;
};

}  // namespace surf::mc
