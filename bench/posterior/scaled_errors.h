// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

namespace surf::bench {

/// An error and its posterior deviation, in any unit.
struct OneError {
  double off = 0, deviation = 1;
  double scaled() const { return off / deviation; }
};

/// Errors over their posterior deviations, which are standard normal if the posterior is right.
/// Those of one fit are not independent, so sampling errors come from the scatter of fits.
class ScaledErrors {
 public:
  /// Errors of one fit.
  void add(const std::string& quantity, int fit, const std::vector<OneError>& errors);

  /// Prints a line: the shares of errors within one and two deviations, with sampling errors, the
  /// mean and root mean square of errors over deviations, and the root mean squares of both.
  void print_coverage(const std::string& quantity) const;
  /// Prints a histogram of the truth's place among the posterior's probability, in tenths, one per
  /// fit, and its chi-squared.
  void print_places(const std::string& quantity) const;

 private:
  std::map<std::string, std::map<int, std::vector<OneError>>> errors_;
};

}  // namespace surf::bench
