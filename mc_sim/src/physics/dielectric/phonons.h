// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "surf/mc/physics/material.h"
#include "surf/mc/physics/mechanism.h"

namespace surf::mc {

inline constexpr double room_temperature_ev = 0.0252489;  ///< kT at 293 K

/// Acoustic phonons, which scatter slow electrons through large angles and take little energy.
/// `in_events`: with the tier that pays for each loss, whose energies count from the bottom of the
/// filled band. Else they count from that of the conduction band, and the continuous loss stands
/// for what phonons take.
std::unique_ptr<const Scattering> make_acoustic_phonons(const Material& material,
                                                        const DielectricData& data,
                                                        bool in_events = true);
/// Phonons below 100 eV, `fast` above 200 eV, and between the two a geometric mean of both: the
/// same mechanisms, faded.
std::vector<std::unique_ptr<const Scattering>> fade(
    std::unique_ptr<const Scattering> phonons, std::vector<std::unique_ptr<const Scattering>> fast);
/// One longitudinal optical mode.
std::unique_ptr<const Scattering> make_optical_phonons(const OpticalMode& mode,
                                                       const DielectricData& data);
/// Polaron traps, which end an electron's way.
std::unique_ptr<const Scattering> make_polaron_traps(const DielectricData& data);

}  // namespace surf::mc
