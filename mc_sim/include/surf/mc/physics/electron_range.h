// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mc/physics/material.h"

namespace surf::mc {

/// How far electrons of this energy get in a material, nm: 27.6 A E^1.67 / (Z^0.89 rho), E in keV,
/// A in g/mol, rho in g/cm^3 (Kanaya and Okayama 1972, doi:10.1088/0022-3727/5/1/308), with the
/// means of A and Z over the atoms of a compound. It was made for 10 to 1000 keV: below, it is a
/// rule of thumb. Throws InvalidInput for an energy that is not above 0 or for a material that
/// `validate` refuses.
double kanaya_okayama_range_nm(const Material& material, double energy_ev);

}  // namespace surf::mc
