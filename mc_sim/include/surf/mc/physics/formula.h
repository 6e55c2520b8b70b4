// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>
#include <vector>

namespace surf::mc {

/// One element of a chemical formula.
struct FormulaPart {
  int atomic_number = 0;
  double atoms = 0;  ///< in a formula unit, > 0
};

/// Reads "SiO2", "C5H8O2", "Ca(OH)2" or "Al0.3Ga0.7As": symbols with counts, whole or decimal, and
/// groups in (), [] or {}. Each element appears once in the result, in the order of the text.
/// Throws UsageError naming `subject` and the place in the text.
std::vector<FormulaPart> parse_formula(std::string_view text, std::string_view subject);

}  // namespace surf::mc
