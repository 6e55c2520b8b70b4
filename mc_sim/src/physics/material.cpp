// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/material.h"

#include <cmath>

#include <fmt/format.h>

#include "surf/core/error.h"

namespace surf::mc {

namespace {

constexpr double avogadro_cm3_per_nm3 = 602.214076;  // N_A in 1/mol, times cm^3 per nm^3

[[noreturn]] void fail(const Material& m, const std::string& reason) {
  throw InvalidInput("material " + (m.name.empty() ? "(no name)" : m.name), reason,
                     "Correct the material's definition");
}

void require(const Material& m, bool ok, const char* field, double value, const char* range) {
  if (!ok) fail(m, fmt::format("{} is {:g} but must be {}", field, value, range));
}

}  // namespace

void validate(const Material& m) {
  auto positive = [](double v) { return std::isfinite(v) && v > 0; };
  auto not_negative = [](double v) { return std::isfinite(v) && v >= 0; };
  require(m, positive(m.density_g_cm3), "density_g_cm3", m.density_g_cm3, "positive");
  if (m.constituents.empty()) fail(m, "it has no elements");
  double sum = 0;
  for (const Constituent& c : m.constituents) {
    require(m, c.atomic_number >= 1 && c.atomic_number <= 92, "atomic number", c.atomic_number,
            "1 to 92");
    require(m, positive(c.atomic_weight), "atomic weight", c.atomic_weight, "positive");
    require(m, positive(c.weight_fraction), "weight fraction", c.weight_fraction, "positive");
    require(m, positive(c.mean_ionization_ev), "mean ionization energy", c.mean_ionization_ev,
            "positive");
    sum += c.weight_fraction;
  }
  require(m, std::fabs(sum - 1) < 1e-6, "the sum of weight fractions", sum, "1");
  require(m, positive(m.formula_weight_g_mol), "formula_weight_g_mol", m.formula_weight_g_mol,
          "positive");
  require(m, positive(m.work_function_ev), "work_function_ev", m.work_function_ev, "positive");
  require(m, not_negative(m.barrier_ev), "barrier_ev", m.barrier_ev, "0 or more");
  require(m, not_negative(m.valence_electrons), "valence_electrons", m.valence_electrons,
          "0 or more");
  require(m, not_negative(m.plasmon_ev), "plasmon_ev", m.plasmon_ev, "0 or more");
  require(m,
          std::isfinite(m.loss_join_ev) &&
              m.loss_join_ev > std::fmax(m.barrier_ev, m.work_function_ev) + 1,
          "loss_join_ev", m.loss_join_ev, "more than 1 eV above the barrier and the work function");
}

double number_density_per_nm3(const Material& m, const Constituent& c) {
  return avogadro_cm3_per_nm3 * m.density_g_cm3 * c.weight_fraction / c.atomic_weight;
}

double atoms_per_formula_unit(const Material& m, const Constituent& c) {
  return m.formula_weight_g_mol * c.weight_fraction / c.atomic_weight;
}

double formula_units_per_nm3(const Material& m) {
  return avogadro_cm3_per_nm3 * m.density_g_cm3 / m.formula_weight_g_mol;
}

}  // namespace surf::mc
