// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace surf {

/// The candidate that a mistyped `word` was most likely meant to be: the nearest by edit distance,
/// where the same letters in another order count as one change; empty if more than a third of the
/// word, or two letters, would have to change.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace surf
