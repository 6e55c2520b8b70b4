// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string_view>

namespace surf::mc {

/// A chemical element, Z = 1 to 92.
struct Element {
  int atomic_number = 0;
  const char* symbol = "";
  double atomic_weight = 0;  ///< g/mol: IUPAC's standard weights of 2021, abridged to five digits;
                             ///< of the longest-lived isotope where there is none
  int valence_electrons =
      0;                   ///< s, p and d electrons outside closed shells, as MONSEL counts them:
                           ///< the group up to 12, then the group less 10; helium 2, lanthanides 3
  int free_electrons = 0;  ///< of a free-electron gas with about the metal's band width: as above,
                           ///< but 2 in the groups 4 to 10 and 12 and 1 in group 11
};

/// All of them, by rising Z.
std::span<const Element> elements();

/// The element of that Z (1 to 92).
const Element& element(int atomic_number);

/// The element of that symbol (case matters), or nullptr.
const Element* find_element(std::string_view symbol);

/// J of the Joy-Luo loss, eV, as MONSEL takes it: Berger and Seltzer's 9.76 Z + 58.8 Z^-0.19 for
/// Z >= 13 (NAS-NRC 1133, 1964), Wilson's 11.5 Z below (Phys. Rev. 60, 749 (1941)).
double mean_ionization_ev(int atomic_number);

}  // namespace surf::mc
