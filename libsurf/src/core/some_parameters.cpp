// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/some_parameters.h"

#include "surf/core/words.h"

namespace surf {

std::vector<int> parse_whole_numbers(std::string_view text, const Parameter& about,
                                     const std::string& subject) {
  std::vector<int> numbers;
  parameters_detail::Calling read(
      [&](const Parameter&, Field& field) { field.read(text, subject); }, true);
  for (const std::string_view part : split(text, ",")) {
    int number = 0;
    text = part;
    read(number, about);
    numbers.push_back(number);
  }
  return numbers;
}

std::vector<double> parse_values(std::string_view text, const Parameter& about,
                                 const std::string& subject) {
  std::vector<double> values;
  for (const std::string_view part : split(text, ","))
    values.push_back(parse_value(part, about, subject));
  return values;
}

}  // namespace surf
