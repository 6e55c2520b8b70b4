// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/nearest.h"

#include <algorithm>

#include "surf/core/words.h"

namespace surf {

namespace {

/// Two letters that changed places are one slip of the hand.
std::size_t slips(const std::string& word, const std::string& candidate) {
  return std::ranges::is_permutation(word, candidate) && word != candidate
             ? 1
             : edit_distance(word, candidate);
}

}  // namespace

std::string nearest(const std::string& word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = slips(word, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace surf
