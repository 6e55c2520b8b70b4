// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "surf/core/vec3.h"

namespace surf::mc {

/// The probability that a detector counts an electron, by its energy and direction as it leaves: a
/// table that is constant within bins. Tables come from what traced electrons through a column, or
/// from measurements.
struct Acceptance {
  /// Edges of the bins of energy in vacuum, eV, rising, at least two. Electrons outside them are
  /// not counted.
  std::vector<double> energy_edges_ev;
  /// Bins from z (up) to -z, all as wide in the sine of half the polar angle: narrow about z, where
  /// detectors in the column look.
  int polar_bins = 90;
  int azimuth_bins = 72;  ///< from +x towards +y, all as wide
  /// From 0 to 1: [energy][polar][azimuth], the last one fastest.
  std::vector<float> probability;

  std::size_t energy_bins() const { return energy_edges_ev.size() - 1; }
};

/// A direction in the middle of a bin.
Vec3 middle_direction(const Acceptance& acceptance, int polar_bin, int azimuth_bin);

/// The probability for an electron. `direction` is of length 1.
double probability(const Acceptance& acceptance, double energy_ev, const Vec3& direction);

/// Whether a detector, one of several that are told apart by `stream`, counts an electron of this
/// probability. The dice are the electron's own energy and direction: the same electron is always
/// counted or never, and no other detector's counts change.
bool is_counted(double probability, double energy_ev, const Vec3& direction, std::uint64_t stream);

/// Hexadecimal digits that differ where tables differ.
std::string hash_of(const Acceptance& acceptance);

/// Throws UsageError naming `subject`: edges that do not rise, a table of another size,
/// probabilities outside 0 to 1.
void validate(const Acceptance& acceptance, const std::string& subject);

}  // namespace surf::mc
