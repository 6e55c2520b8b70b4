// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/sim/materials.h"

#include <fmt/format.h>

#include "sim/materials_data.h"
#include "sim/suggest.h"
#include "sim/toml_table.h"
#include "surf/core/error.h"

namespace surf::io {
namespace {

double required(const TomlTable& table, std::string_view key) {
  table.require(key, "every material has it");
  return *table.number(key);
}

int whole(const TomlTable& table, std::string_view key) {
  table.require(key, "every element has it");
  return static_cast<int>(*table.integer(key));
}

mc::Constituent read_element(const TomlTable& table) {
  table.allow({"Z", "A", "weight_fraction", "J_ev"});
  return {.atomic_number = whole(table, "Z"),
          .atomic_weight = required(table, "A"),
          .weight_fraction = table.number("weight_fraction").value_or(1),
          .mean_ionization_ev = required(table, "J_ev")};
}

mc::Material read_material(const TomlTable& table) {
  table.allow({"name", "density_g_cm3", "elements", "work_function_ev", "barrier_ev",
               "valence_electrons", "plasmon_ev", "loss_join_ev", "loss_join_fitted", "sources"});
  table.require("name", "every material has one");
  mc::Material material;
  material.name = *table.text("name");
  material.density_g_cm3 = required(table, "density_g_cm3");
  for (const TomlTable& element : table.tables("elements")) {
    material.constituents.push_back(read_element(element));
  }
  material.work_function_ev = required(table, "work_function_ev");
  material.barrier_ev = required(table, "barrier_ev");
  material.valence_electrons = required(table, "valence_electrons");
  material.plasmon_ev = table.number("plasmon_ev").value_or(0);
  material.loss_join_ev = required(table, "loss_join_ev");
  material.loss_join_fitted = table.flag("loss_join_fitted").value_or(false);
  material.sources = table.text("sources").value_or("");
  mc::validate(material);
  return material;
}

std::vector<mc::Material> read_materials() {
  const TomlTable root = TomlTable::parse(materials_toml, "materials.toml");
  root.allow({"material"});
  std::vector<mc::Material> materials;
  for (const TomlTable& table : root.tables("material")) materials.push_back(read_material(table));
  return materials;
}

}  // namespace

const std::vector<mc::Material>& builtin_materials() {
  static const std::vector<mc::Material> materials = read_materials();
  return materials;
}

const mc::Material& find_material(const std::string& name, const std::string& subject) {
  std::vector<std::string> names;
  for (const mc::Material& material : builtin_materials()) {
    if (material.name == name) return material;
    names.push_back(material.name);
  }
  throw UsageError(subject, fmt::format("there is no material '{}'", name),
                   fmt::format("Choose one of: {}", join(nearest_first(name, std::move(names)))));
}

}  // namespace surf::io
