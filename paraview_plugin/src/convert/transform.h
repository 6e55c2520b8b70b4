// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>

#include "surf/core/affine.h"

namespace surf::pv {

/// Six numbers, xx xy x0 yx yy y0, as properties hold them. Throws UsageError naming Transform if
/// there is no way back.
Affine to_affine(const double numbers[6]);

/// The same as text, for field data.
inline constexpr const char* transform_text = "sem_to_afm";
std::string text_of(const Affine& map);

}  // namespace surf::pv
