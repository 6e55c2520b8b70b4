// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The mechanisms that come with semsurf. To add one: write its file beside the others, declare its
// maker here, and call it in make_medium (medium.cpp).

#include <memory>

#include "surf/mc/physics/mechanism.h"
#include "surf/mc/physics/physics.h"

namespace surf::mc {

std::unique_ptr<const Scattering> make_mott(const Material&, const Constituent&,
                                            MottAtoms = MottAtoms::free);
std::unique_ptr<const Scattering> make_browning(const Material&, const Constituent&);
std::unique_ptr<const Scattering> make_moller(const Material&, const Physics&);
std::unique_ptr<const Scattering> make_plasmon(const Material&, const Physics&);
std::unique_ptr<const Scattering> make_dielectric(const Material&, const Physics&);
std::unique_ptr<const ContinuousLoss> make_joy_luo(const Material&, const Physics&);

/// Elastic scattering by the material's atoms, weighted with 1 - cos theta, per nm; the energy at
/// least 100 eV.
double inverse_transport_path_per_nm(const Material& material, double energy_ev);

/// Browning's total elastic cross-section, nm^2.
double browning_cross_section_nm2(int atomic_number, double energy_ev);
/// That weighted with 1 - cos theta.
double browning_transport_cross_section_nm2(int atomic_number, double energy_ev);

/// Where the highest filled level lies in the frame of the transport loop, eV: the Fermi energy of
/// a metal, minus the gap of an insulator; minus the work function where the barrier is off and
/// energies count from the vacuum level.
inline double filled_level_ev(const Material& material, const Physics& physics) {
  const double zero = physics.barrier == BarrierModel::off ? 0.0 : material.barrier_ev;
  return zero - material.work_function_ev;
}

}  // namespace surf::mc
