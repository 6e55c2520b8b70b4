// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "surf/mc/physics/mechanism.h"
#include "surf/mc/physics/physics.h"

namespace surf::mc {

/// Energy bins, `per_octave` to a factor of two, evenly spaced inside an octave, so that an
/// energy's bin is a few of its leading bits. They cover 0.5 eV to 65.5 keV.
struct EnergyBins {
  static constexpr int log2_per_octave = 4;
  static constexpr int per_octave = 1 << log2_per_octave;
  static constexpr int octaves = 17;
  static constexpr int count = octaves * per_octave;
  static constexpr double lowest_ev = min_cutoff_ev;

  static int bin(double energy_ev) {
    constexpr int shift = 52 - log2_per_octave;
    constexpr auto base = std::bit_cast<std::uint64_t>(lowest_ev) >> shift;
    const auto i = static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(energy_ev) >> shift) -
                   static_cast<std::int64_t>(base);
    return static_cast<int>(i < 0 ? 0 : i >= count ? count - 1 : i);
  }
  static double lower_ev(int bin) {
    constexpr int shift = 52 - log2_per_octave;
    const auto base = std::bit_cast<std::uint64_t>(lowest_ev) >> shift;
    return std::bit_cast<double>((base + static_cast<std::uint64_t>(bin)) << shift);
  }
};

/// A material's mechanisms, compiled for the transport loop. Within an energy bin (3 to 6 % wide)
/// event rates and stopping power are constant, at their averages over the bin; with that, free
/// path and energy loss are sampled together exactly, however much energy a free path costs.
///
/// Where there is a continuous loss, the rates of the mechanisms that make secondaries are adjusted
/// so that the energy they hand out is on average the energy lost: see medium.cpp.
class Medium {
 public:
  Medium(std::vector<std::unique_ptr<const Scattering>> scatterings,
         std::unique_ptr<const ContinuousLoss> loss, double barrier_ev, double cutoff_ev);

  double barrier_ev() const { return barrier_ev_; }
  double cutoff_ev() const { return cutoff_ev_; }

  /// The way to the next event or, if `stopped`, to where the energy reaches the cutoff.
  struct Step {
    double length_nm;
    double energy_ev;  ///< at its end
    bool stopped;
  };

  /// `optical_depth` is the number of mean free paths to go: -ln(u) for u uniform in (0, 1).
  Step step(double energy_ev, double optical_depth) const {
    int i = EnergyBins::bin(energy_ev);
    double path = 0;
    double energy = energy_ev;
    for (;;) {
      const Bin& bin = bins_[static_cast<std::size_t>(i)];
      const double to_edge = (energy - bin.lower_ev) * bin.nm_per_ev;
      const double depth = to_edge * bin.rate_per_nm;
      if (optical_depth < depth) {
        const double last = optical_depth * bin.mean_free_path_nm;
        return {path + last, energy - last * bin.ev_per_nm, false};
      }
      optical_depth -= depth;
      path += to_edge;
      energy = bin.lower_ev;
      if (i-- <= cutoff_bin_) return {path, energy, true};
    }
  }

  /// Energy left after `length_nm`, not below the cutoff.
  double energy_after(double energy_ev, double length_nm) const;

  /// Neither the electron nor any secondary of its gets farther from where it is. With continuous
  /// loss it is the path length until the cutoff, as secondaries never have more energy than the
  /// electron has when it makes them. Where losses are paid event by event, no such length exists:
  /// one in a million gets farther at most. Practically endless without any loss.
  double range_nm(double energy_ev) const {
    const Bin& bin = bins_[static_cast<std::size_t>(EnergyBins::bin(energy_ev))];
    return bin.range_nm + (energy_ev - bin.lower_ev) * bin.range_nm_per_ev;
  }
  /// `at_edges`: range_nm at the edges of energy bins, one more than there are bins.
  void set_range(const std::vector<double>& at_edges);

  /// The mechanism of an event at this energy; `u` uniform in [0, 1).
  const Scattering& choose(double energy_ev, double u) const {
    const std::size_t n = scatterings_.size();
    const float* p = &cumulative_[static_cast<std::size_t>(EnergyBins::bin(energy_ev)) * n];
    std::size_t k = 0;
    while (k + 1 < n && u >= p[k]) ++k;
    return *scatterings_[k];
  }

  /// Whether energy falls by continuous loss alone.
  bool loses_continuously() const;
  /// Whether energy falls in events alone, which pay for the secondaries that they make.
  bool loses_in_events() const { return loses_in_events_; }

  double stopping_power_ev_per_nm(double energy_ev) const;
  double inverse_mean_free_path_per_nm(double energy_ev) const;
  std::vector<std::string> describe() const;

 private:
  struct Bin {
    double lower_ev;
    double nm_per_ev;
    double ev_per_nm;
    double rate_per_nm;
    double mean_free_path_nm;
    double range_nm;  // of an electron at lower_ev
    double range_nm_per_ev;
  };

  struct RateFactors {
    double fixed;     // for mechanisms that keep their published rate where it can be paid
    double flexible;  // for those that take the remaining loss
  };
  RateFactors rate_factors(double energy_ev, double power_ev_per_nm) const;

  std::vector<std::unique_ptr<const Scattering>> scatterings_;
  std::unique_ptr<const ContinuousLoss> loss_;
  bool loses_in_events_;
  double barrier_ev_;
  double cutoff_ev_;
  int cutoff_bin_;
  std::vector<Bin> bins_;
  std::vector<float> cumulative_;  // [bin][scattering]: probability of this one or one before it
};

/// The medium that `physics` makes of a material.
Medium make_medium(const Material& material, const Physics& physics);

}  // namespace surf::mc
