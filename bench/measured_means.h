// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Measured yields to compare with: for fit_loss_join and yields_of_materials.

#include <cmath>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "surf/io/csv_line.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/physics/element.h"

namespace surf::bench {

/// Geometric means of measured values by element and energy in keV.
using Means = std::map<std::string, std::map<double, double>>;

/// Reads CSV files with the columns element, energy_keV, `column` and perhaps quantity. Where the
/// quantity is SE+BSE the key is "SE+BSE of ELEMENT".
inline Means read_means(const std::vector<std::string>& paths, const std::string& column) {
  std::map<std::string, std::map<double, std::vector<double>>> all;
  for (const std::string& path : paths) {
    std::ifstream in(path);
    std::string line;
    if (!std::getline(in, line)) throw std::runtime_error(path + ": cannot be read");
    const std::vector<std::string> names = io::split_csv_line(line);
    while (std::getline(in, line)) {
      const std::vector<std::string> fields = io::split_csv_line(line);
      std::map<std::string, std::string> row;
      for (std::size_t i = 0; i < names.size() && i < fields.size(); ++i) row[names[i]] = fields[i];
      if (!row.contains("element") || !row.contains(column)) continue;
      const bool both = row["quantity"] == "SE+BSE";
      // 1.02 keV and the like were meant as the round number beside them.
      const double energy = std::round(std::stod(row["energy_keV"]) * 20) / 20;
      all[(both ? "SE+BSE of " : "") + row["element"]][energy].push_back(
          std::log(std::stod(row[column])));
    }
  }
  Means means;
  for (const auto& [element, energies] : all)
    for (const auto& [energy, logs] : energies) {
      double sum = 0;
      for (const double l : logs) sum += l;
      means[element][energy] = std::exp(sum / static_cast<double>(logs.size()));
    }
  return means;
}

/// The key of a material's measurements: its name or, for a pure element in another form, the
/// element's symbol.
inline std::string measured_as(const mc::Material& material, const Means& means) {
  if (means.contains(material.name) || material.constituents.size() != 1) return material.name;
  return mc::element(material.constituents[0].atomic_number).symbol;
}

}  // namespace surf::bench
