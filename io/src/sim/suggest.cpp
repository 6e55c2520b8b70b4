// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/suggest.h"

#include <algorithm>
#include <cctype>

#include "surf/core/words.h"

namespace surf::io {
namespace {

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

/// From the key, or from what it is without its last words: the unit of "density_g_cm3" is easily
/// forgotten.
std::size_t key_distance(const std::string& wanted, const std::string& key) {
  std::size_t least = edit_distance(wanted, key);
  for (std::size_t end = key.find('_'); end != std::string::npos; end = key.find('_', end + 1))
    least = std::min(least, edit_distance(wanted, key.substr(0, end)));
  return least;
}

}  // namespace

std::vector<std::string> nearest_first(std::string_view word, std::vector<std::string> known) {
  const std::string wanted = lower_case(word.substr(0, 100));
  const auto distance = [&](const std::string& key) {
    return key_distance(wanted, lower_case(key));
  };
  std::stable_sort(known.begin(), known.end(), [&](const std::string& a, const std::string& b) {
    return distance(a) < distance(b);
  });
  return known;
}

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace surf::io
