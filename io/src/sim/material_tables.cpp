// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/material_tables.h"

#include <fmt/format.h>

#include <set>
#include <string>

#include "surf/core/error.h"
#include "surf/io/sim/scene_keys.h"
#include "surf/mc/physics/element.h"
#include "surf/mc/physics/material_draft.h"

namespace surf::io {
namespace {

double required(const TomlTable& table, std::string_view key) {
  table.require(key, "every material has it");
  return *table.number(key);
}

int read_atomic_number(const TomlTable& table) {
  if (table.has("Z") == table.has("symbol")) {
    throw FileError(table.place(), "it needs either 'Z' or 'symbol'", "Write for example symbol = \"Si\"");
  }
  if (table.has("symbol")) {
    const mc::Element* const element = mc::find_element(*table.text("symbol"));
    if (!element) {
      throw UsageError(table.place("symbol"),
                       fmt::format("there is no element '{}'", table.text("symbol")->substr(0, 20)),
                       "Write a symbol such as \"Si\"; case matters");
    }
    return element->atomic_number;
  }
  const std::int64_t z = *table.integer("Z");
  if (z < 1 || z > static_cast<std::int64_t>(mc::elements().size())) {
    throw UsageError(table.place("Z"), fmt::format("there is no element {}", z),
                     "Give an atomic number from 1 to 92");
  }
  return static_cast<int>(z);
}

mc::Constituent read_element(const TomlTable& table) {
  table.allow(keys_of("elements"));
  return {.atomic_number = read_atomic_number(table),
          .atomic_weight = table.number("A").value_or(0),
          .weight_fraction = table.number("weight_fraction").value_or(1),
          .mean_ionization_ev = table.energy_ev("J_ev").value_or(0)};
}

mc::MaterialDraft read_draft(const TomlTable& table) {
  table.allow(keys_of("material"));
  table.require("name", "every material has one");
  if (table.has("formula") == table.has("elements")) {
    throw FileError(table.place(),
                    fmt::format("it needs either 'formula' or 'elements'{}",
                                table.has("formula") ? ", not both" : ""),
                    "Write for example formula = \"SiO2\"");
  }
  mc::MaterialDraft draft;
  draft.name = *table.text("name");
  if (draft.name.empty()) {
    throw UsageError(table.place("name"), "the name is empty", "Give it a name");
  }
  draft.density_g_cm3 = required(table, "density_g_cm3");
  if (const auto formula = table.text("formula")) {
    draft.formula = mc::parse_formula(*formula, table.place("formula"));
  }
  for (const TomlTable& element : table.tables("elements")) {
    draft.constituents.push_back(read_element(element));
  }
  draft.band_gap_ev = table.energy_ev("band_gap_ev");
  draft.work_function_ev = table.energy_ev("work_function_ev");
  draft.barrier_ev = table.energy_ev("barrier_ev");
  draft.valence_electrons = table.number("valence_electrons");
  draft.plasmon_ev = table.energy_ev("plasmon_ev");
  draft.loss_join_ev = table.energy_ev("loss_join_ev");
  draft.loss_join_fitted = table.flag("loss_join_fitted").value_or(false);
  draft.sources = table.text("sources").value_or("");
  return draft;
}

}  // namespace

std::vector<mc::Material> read_material_tables(const TomlTable& root,
                                               std::span<const mc::Material> known) {
  std::vector<mc::Material> materials;
  std::set<std::string> names;
  for (const TomlTable& table : root.tables("material")) {
    const mc::MaterialDraft draft = read_draft(table);
    if (!names.insert(draft.name).second) {
      throw UsageError(table.place("name"), fmt::format("there are two materials '{}'", draft.name),
                       "Rename or remove one of them");
    }
    try {
      materials.push_back(mc::complete(draft, known));
    } catch (const InvalidInput& error) {
      throw InvalidInput(table.place(), error.subject() + ": " + error.reason(), error.remedy());
    }
  }
  return materials;
}

}  // namespace surf::io
