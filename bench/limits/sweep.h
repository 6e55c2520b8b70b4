// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "surf/io/plot.h"

namespace surf::limits {

/// The figures of one sweep: a line of numbers for each value that was tried.
struct Table {
  std::vector<std::string>
      columns;  ///< with units: "threshold_sigma", "rms_nm"; the swept one first
  std::vector<std::vector<double>> rows;  ///< NaN: there is none, as where the program refuses

  /// Throws InvalidInput for a name that is no column.
  std::vector<double> column(const std::string& name) const;
};

/// One way to make a method fail, step by step (docs/explanation/limits.md).
struct Sweep {
  std::string name;      ///< of its files in docs/explanation/limits
  std::string question;  ///< what it shows, one line, no full stop
  std::vector<std::string> columns;
  std::vector<double> values;  ///< of the first column
  /// The other columns at a value: a function of nothing else, the same with any number of threads.
  std::function<std::vector<double>(double value)> at;
  /// The value that the tests recompute: a quick one, where something happens.
  double checked = 0;
  /// How far it may be off, relative, where instructions round otherwise: far from the optimum a
  /// reconstruction ends per cents elsewhere.
  double tolerance = 1e-6;
  std::function<io::Plot(const Table&)> plot;
};

/// All sweeps, by name. A new one: its file, a line in sweeps.cpp and in CMakeLists.txt.
std::span<const Sweep> sweeps();

/// CSV, with 9 digits; an empty field where there is no number. Reading throws InvalidInput, naming
/// `subject`.
std::string to_csv(const Table& table);
Table from_csv(const std::string& text, const std::string& subject);

/// Columns against the first one; what is NaN is left out. A column's error bars are in NAME_error,
/// if there is one.
struct Curve {
  std::string column, name;  ///< name: in the legend
  bool dashed = false;
};
io::PlotPanel panel(const Table& table, const std::string& title, const io::PlotAxis& x,
                    const io::PlotAxis& y, const std::vector<Curve>& curves);

}  // namespace surf::limits
