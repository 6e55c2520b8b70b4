// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace surf::workflow {

/// A setting that a sweep varies.
struct SweepAxis {
  std::string name;                 ///< "energy"
  std::vector<std::string> values;  ///< "500eV", as texts for the parameter
};

/// Values as "500eV,1keV" or "0deg:60deg:5deg", whose end is included where a whole number of steps
/// leads there. Throws UsageError that names `subject`.
std::vector<std::string> parse_sweep_values(const std::string& text, const std::string& subject);

/// All combinations, the last axis the fastest. Throws UsageError for axes given twice and more
/// than a million.
class SweepGrid {
 public:
  SweepGrid(std::vector<SweepAxis> axes, const std::string& subject);

  const std::vector<SweepAxis>& axes() const { return axes_; }
  std::size_t runs() const { return runs_; }
  std::vector<std::string> values(std::size_t run) const;
  /// "energy_500eV,tilt_5deg": what no file system minds.
  std::string file_name(std::size_t run) const;
  /// The runs whose settings are to be looked at before the first begins, so that a mistake in the
  /// last value does not wait for all others: all, or the first and the last of very many.
  std::vector<std::size_t> tried() const;

 private:
  std::vector<SweepAxis> axes_;
  std::size_t runs_ = 1;
};

}  // namespace surf::workflow
