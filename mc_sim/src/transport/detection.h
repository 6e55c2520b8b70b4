// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "surf/mc/transport/detector.h"
#include "surf/mc/transport/spectra.h"
#include "surf/mc/transport/tally.h"

namespace surf::mc {

/// An electron that has left the specimen for good.
struct Escape {
  double energy_ev = 0;  ///< in vacuum
  Vec3 direction;
  bool secondary = false;
  bool turned = false;  ///< generated after the primary had turned by more than 90 degrees
};

/// Detectors at work: counts the electrons of one primary at a time. One per thread.
class Detection {
 public:
  Detection(const std::vector<Detector>& detectors, const Beam& beam, bool with_spectra);

  void escaped(const Escape& e) {
    for (std::size_t i = 0; i < detectors_.size(); ++i)
      if (accepts(detectors_[i], e)) count(i, e);
  }

  /// Electrons of the current primary on each detector.
  const std::vector<int>& counts() const { return counts_; }

  /// Closes the current primary: its spectra are added up, its counts set to 0.
  void end_primary();

  /// Spectra of the primaries since the last call; empty without.
  std::vector<Spectra> take_spectra();

 private:
  struct Compiled {
    double min_energy, max_energy;
    Side side;
    Origin origin;
    bool whole_sphere, whole_turn;
    Vec3 axis, across, up;
    double min_cosine, max_cosine;  // counted: min <= cosine < max
    double from_turn_deg, to_turn_deg;
    std::shared_ptr<const Acceptance> acceptance;
    std::uint64_t stream;  // of the acceptance's dice
  };

  static Compiled compile(const Detector& detector, const Beam& beam);
  static bool accepts(const Compiled& d, const Escape& e);
  static bool in_sector(const Compiled& d, const Vec3& direction);
  static double azimuth_deg(const Compiled& d, const Vec3& direction);
  void count(std::size_t detector, const Escape& e);
  void touch(Histogram& histogram, double value);

  std::vector<Compiled> detectors_;
  std::vector<int> counts_;
  std::vector<Spectra> spectra_;
  std::vector<Counts*> touched_;  // bins that the current primary has counts in, once per count
};

}  // namespace surf::mc
