// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "surf/io/csv_line.h"

namespace surf::test {

/// The rows of a file in data/reference, each from column name to text. Quoted fields may hold
/// commas.
inline std::vector<std::map<std::string, std::string>> read_reference(const std::string& name) {
  std::ifstream in(std::string(SEMSURF_REFERENCE_DATA) + "/" + name);
  if (!in) throw std::runtime_error("no reference data " + name);
  std::string line;
  std::getline(in, line);
  const auto names = io::split_csv_line(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(in, line)) {
    const auto fields = io::split_csv_line(line);
    std::map<std::string, std::string> row;
    for (std::size_t i = 0; i < names.size() && i < fields.size(); ++i) row[names[i]] = fields[i];
    rows.push_back(std::move(row));
  }
  return rows;
}

inline double number(const std::map<std::string, std::string>& row, const std::string& column) {
  return std::stod(row.at(column));
}

}  // namespace surf::test
