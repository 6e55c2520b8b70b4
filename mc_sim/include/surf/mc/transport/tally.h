// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace surf::mc {

/// Energies are summed as whole multiples of 2^-16 eV, so that sums do not depend on their order.
class EnergySum {
 public:
  void add(double energy_ev) {
    const double scaled = energy_ev * 65536.0;
    sum_ += static_cast<std::int64_t>(scaled < 0 ? scaled - 0.5 : scaled + 0.5);
  }
  EnergySum& operator+=(const EnergySum& b) {
    sum_ += b.sum_;
    return *this;
  }
  double ev() const { return static_cast<double>(sum_) / 65536.0; }

  /// The sum as it is kept, in 2^-16 eV.
  std::int64_t parts() const { return sum_; }
  static EnergySum of_parts(std::int64_t parts) {
    EnergySum e;
    e.sum_ = parts;
    return e;
  }

 private:
  std::int64_t sum_ = 0;  // 1e14 eV in all: 3e9 primaries of 30 keV
};

/// Why an electron was given up. None of these should happen on a closed specimen.
enum class LossCause {
  no_surface_ahead,      ///< inside a body, but nothing to leave it through
  wrong_side,            ///< met a surface from the side it was not on
  too_many_steps,        ///< a cascade of 10^8 steps
  too_many_secondaries,  ///< 10^6 electrons waiting to be followed
};
inline constexpr int loss_causes = 4;
const char* name(LossCause cause);

/// Where all electrons and all energy went:
///   incident + generated = se + bse + transmitted + absorbed + lost
///   incident + generated energy = escaped + deposited + lost energy
/// Energies are total energies: kinetic energy inside minus the barrier, so that crossing a surface
/// changes nothing. Secondaries are not debited from the electron that made them (the continuous
/// loss pays for them), so `generated` is a source of energy of its own.
struct Balance {
  std::int64_t incident = 0;     ///< primaries, those that miss everything included
  std::int64_t missed = 0;       ///< primaries that met nothing; they also count as transmitted
  std::int64_t generated = 0;    ///< secondaries
  std::int64_t se = 0;           ///< left for good below 50 eV, in any direction
  std::int64_t bse = 0;          ///< left for good at 50 eV or more, upward
  std::int64_t transmitted = 0;  ///< left for good at 50 eV or more, downward: not detected
  std::int64_t absorbed = 0;     ///< stopped inside
  std::int64_t dropped = 0;      ///< of those: given up early, too far from any surface to matter
  std::array<std::int64_t, loss_causes> lost{};

  EnergySum incident_energy, generated_energy, escaped_energy, deposited_energy, lost_energy;

  std::int64_t steps = 0;        ///< path segments inside matter and in vacuum
  std::int64_t rays = 0;         ///< segments that asked for the surface
  std::int64_t handed_over = 0;  ///< electrons of replayed primaries that were simulated directly

  std::int64_t total_lost() const;
  Balance& operator+=(const Balance& other);
};

/// What gave a pixel its value.
enum class PixelModel : std::int64_t {
  none,  ///< the beam misses everything
  direct,
  replay,
  difference,  ///< replay, as the difference to the outcome on a plane
  plane,       ///< the surface is proved to be a plane as far as electrons reach
};

/// What happened to the primaries of one pixel, whatever is detected.
struct PixelTally {
  std::int64_t primaries = 0;  ///< whose counts were kept
  std::int64_t hits = 0;       ///< primaries that met the specimen
  PixelModel model = PixelModel::none;

  PixelTally& operator+=(const PixelTally& other);
};

/// Electrons counted over many primaries: the sum of each primary's number and of its square. Both
/// are whole numbers, so sums are exact and merge in any order.
struct Counts {
  std::int64_t sum = 0;
  std::int64_t squares = 0;

  void add(std::int64_t of_one_primary) {
    sum += of_one_primary;
    squares += of_one_primary * of_one_primary;
  }
  Counts& operator+=(const Counts& b) {
    sum += b.sum;
    squares += b.squares;
    return *this;
  }
  friend bool operator==(const Counts&, const Counts&) = default;
};

/// What is known of a pixel's yield beside its counts: they are then of the difference to a
/// control, whose mean this is.
struct Control {
  double mean = 0;            ///< counts per primary; 0 without a control
  double standard_error = 0;  ///< of it, from the library's size
  double variance_left = 1;   ///< variance of a primary's counts over what it is without control
};

/// Counts in bins of equal width from `lower` to `upper`; what lies outside is in no bin.
struct Histogram {
  double lower = 0, upper = 0;
  std::vector<Counts> bins;

  /// The bin of a value, or -1.
  int bin(double value) const {
    if (!(value >= lower && value < upper)) return -1;
    const int i = static_cast<int>((value - lower) / (upper - lower) * double(bins.size()));
    return i < static_cast<int>(bins.size()) ? i : static_cast<int>(bins.size()) - 1;
  }
  double edge(std::size_t i) const {
    return lower + (upper - lower) * double(i) / double(bins.size());
  }
  Histogram& operator+=(const Histogram& other);  ///< the same bins
};

/// Mean counts per primary, and the standard error of that mean from the scatter of the primaries'
/// totals: sqrt((mean of x^2 - (mean of x)^2) / (n - 1)); 0 for fewer than two primaries.
struct Estimate {
  double mean = 0;
  double standard_error = 0;
};
Estimate estimate(std::int64_t primaries, const Counts& counts);

}  // namespace surf::mc
