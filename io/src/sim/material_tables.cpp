// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/material_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <string>

#include "surf/core/error.h"
#include "surf/io/files.h"
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
    throw FileError(table.place(), "it needs either 'Z' or 'symbol'",
                    "Write for example symbol = \"Si\"");
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

// One number, or as many as there are.
std::vector<double> read_numbers(const TomlTable& table, std::string_view key,
                                 std::size_t wanted = 0) {
  std::vector<double> numbers;
  for (const std::string& word : table.words(key)) {
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size())
      throw UsageError(table.place(key), fmt::format("'{}' is not a number", word),
                       "Write numbers, as [9130, 5842]");
    numbers.push_back(value);
  }
  if (wanted > 0 && !numbers.empty() && numbers.size() != wanted)
    throw UsageError(
        table.place(key),
        fmt::format("there are {} numbers for {} speeds of sound", numbers.size(), wanted),
        "Give as many as in sound_m_s");
  return numbers;
}

std::vector<mc::AcousticBranch> read_acoustic(const TomlTable& table) {
  const std::vector<double> speeds = read_numbers(table, "sound_m_s");
  if (speeds.size() > 2)
    throw UsageError(table.place("sound_m_s"),
                     fmt::format("there are {} speeds of sound", speeds.size()),
                     "Give one, or that of longitudinal and that of transverse waves");
  const auto deformations =
      read_numbers(table, "deformation_ev", std::max<std::size_t>(speeds.size(), 1));
  const auto bends = read_numbers(table, "bend_m2_s", std::max<std::size_t>(speeds.size(), 1));
  std::vector<mc::AcousticBranch> branches;
  for (std::size_t i = 0; i < speeds.size(); ++i)
    branches.push_back({speeds[i], i < deformations.size() ? deformations[i] : 0,
                        i < bends.size() ? bends[i] : 0,
                        speeds.size() == 1 ? 3
                        : i == 0           ? 1
                                           : 2});
  return branches;
}

mc::DielectricDraft read_dielectric(const TomlTable& table, const TextReader& read) {
  table.allow(keys_of("dielectric"));
  mc::DielectricDraft draft;
  if (const auto file = table.text("energy_loss_function"))
    draft.elf = mc::parse_energy_loss_function(read(*file), *file);
  draft.elf_density_g_cm3 = table.number("energy_loss_density_g_cm3");
  draft.filled_band_ev = table.energy_ev("filled_band_ev");
  draft.gap_ev = table.energy_ev("gap_ev");
  draft.vacuum_ev = table.energy_ev("vacuum_ev");
  draft.refractive_index = table.number("refractive_index");
  draft.lattice_nm = table.number("lattice_nm");
  draft.resistivity_ohm_m = table.number("resistivity_ohm_m");
  draft.effective_mass = table.number("effective_mass");
  draft.density_of_states_mass = table.number("density_of_states_mass");
  draft.acoustic = read_acoustic(table);
  if (table.has("optical_phonons")) {
    draft.optical.emplace();
    for (const TomlTable& mode : table.tables("optical_phonons")) {
      mode.allow(keys_of("optical_phonons"));
      for (const char* key : {"energy_ev", "high_permittivity", "low_permittivity"})
        mode.require(key, "every mode has it");
      draft.optical->push_back({*mode.energy_ev("energy_ev"), *mode.number("high_permittivity"),
                                *mode.number("low_permittivity")});
    }
  }
  draft.trap_per_nm = table.number("trap_per_nm").value_or(0);
  draft.trap_ev = table.energy_ev("trap_ev").value_or(0);
  draft.sources = table.text("sources").value_or("");
  return draft;
}

mc::MaterialDraft read_draft(const TomlTable& table, const TextReader& read) {
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
  if (const auto dielectric = table.table("dielectric"))
    draft.dielectric = read_dielectric(*dielectric, read);
  draft.sources = table.text("sources").value_or("");
  return draft;
}

}  // namespace

TextReader reader_beside(const std::filesystem::path& file) {
  constexpr std::size_t max_bytes = std::size_t{16} << 20;
  return [folder = file.parent_path()](const std::string& name) {
    return read_file(folder / name, max_bytes);
  };
}

std::vector<mc::Material> read_material_tables(const TomlTable& root,
                                               std::span<const mc::Material> known,
                                               const TextReader& read) {
  std::vector<mc::Material> materials;
  std::set<std::string> names;
  for (const TomlTable& table : root.tables("material")) {
    const mc::MaterialDraft draft = read_draft(table, read);
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
