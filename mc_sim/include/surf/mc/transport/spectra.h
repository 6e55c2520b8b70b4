// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "surf/mc/geometry/beam.h"
#include "surf/mc/transport/detector.h"
#include "surf/mc/transport/tally.h"

namespace surf::mc {

/// How the electrons of one detector are spread, over all pixels of a scan.
struct Spectra {
  Histogram energy_ev;  ///< in vacuum: 100 bins over the detector's window, up to the beam's energy
  Histogram polar_deg;  ///< angle from z: 90 bins of 2 degrees
  Histogram azimuth_deg;  ///< from x towards y: 72 bins of 5 degrees

  Spectra& operator+=(const Spectra& other);  ///< of the same detector
};

/// The empty spectra of a detector.
Spectra make_spectra(const Detector& detector, const Beam& beam);

}  // namespace surf::mc
