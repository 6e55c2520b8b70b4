// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "surf/mc/physics/physics.h"

namespace surf::mc {

/// Elastic scattering of one element at one energy: cross-sections and the inverse cumulative
/// distribution of mu = (1 - cos theta) / 2 in 257 points (see mott.cpp).
struct MottRow {
  static constexpr int points = 257;
  double energy_ev;
  double cross_section_nm2;
  double transport_cross_section_nm2;
  double a;  ///< shape of mu = a x / (1 + a - x)
  float x[points];
};

struct MottElement {
  int atomic_number;
  std::span<const MottRow> rows;  ///< rising in energy
};

/// ELSEPA tables (Salvat, Jablonski, Powell, doi:10.1016/j.cpc.2004.09.006), made at build time
/// from data/mott: of free atoms, with the settings of NIST SRD 64, and of atoms in a solid.
std::span<const MottElement> free_mott_elements();
std::span<const MottElement> solid_mott_elements();

/// The element's tables, or nullptr.
const MottElement* find_mott_element(int atomic_number, MottAtoms atoms = MottAtoms::free);

}  // namespace surf::mc
