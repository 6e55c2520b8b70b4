// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "commands.h"
#include "surf/core/units.h"
#include "surf/io/sim/materials.h"

namespace surf::cli {
namespace {

constexpr const char* examples = R"(Examples:
  semsurf materials         the table
  semsurf materials Si      every number of silicon, with its source)";

void print_table() {
  fmt::print("{:<8} {:>8} {:>10} {:>10} {:>10} {:>8}  {}\n", "name", "g/cm^3", "work, eV",
             "barrier, eV", "plasmon, eV", "E_b, eV", "SE yield");
  for (const mc::Material& m : io::builtin_materials())
    fmt::print("{:<8} {:>8} {:>10} {:>11} {:>11} {:>8}  {}\n", m.name, m.density_g_cm3,
               m.work_function_ev, m.barrier_ev,
               m.plasmon_ev > 0 ? format_exact(m.plasmon_ev) : "none", m.loss_join_ev,
               m.loss_join_fitted ? "fitted" : "unfitted");
}

void print_material(const mc::Material& m) {
  const auto line = [](const char* label, const std::string& value, const char* unit) {
    fmt::print("  {:<38} {}{}{}\n", label, value, *unit ? " " : "", unit);
  };
  fmt::print("{}\n", m.name);
  line("density", format_exact(m.density_g_cm3), "g/cm^3");
  line("work function W", format_exact(m.work_function_ev), "eV");
  line("surface barrier U0", format_exact(m.barrier_ev), "eV");
  line("valence electrons per formula unit", format_exact(m.valence_electrons), "");
  line("plasmon energy", m.plasmon_ev > 0 ? format_exact(m.plasmon_ev) : "none",
       m.plasmon_ev > 0 ? "eV" : "");
  line("E_b, where the low-energy loss joins",
       format_exact(m.loss_join_ev) + " eV" +
           (m.loss_join_fitted ? " (fitted to measured SE yields)" : " (unfitted)"), "");
  for (const mc::Constituent& c : m.constituents) {
    fmt::print("  element Z = {}, {:.4g} % of the mass\n", c.atomic_number,
               100 * c.weight_fraction);
    line("  atomic weight", format_exact(c.atomic_weight), "g/mol");
    line("  mean ionization energy J", format_exact(c.mean_ionization_ev), "eV");
    line("  atoms", fmt::format("{:.4g}", mc::number_density_per_nm3(m, c)), "per nm^3");
    line("  Mott table", mc::has_mott_table(c.atomic_number) ? "yes" : "no", "");
  }
  if (!m.sources.empty()) fmt::print("  sources: {}\n", m.sources);
}

}  // namespace

void add_materials(CLI::App& app, Action& action) {
  const auto name = std::make_shared<std::string>();
  CLI::App* sub = app.add_subcommand("materials", "The built-in materials and their numbers");
  sub->add_option("NAME", *name, "Show this one, with sources")->type_name("MATERIAL");
  sub->group("Commands");
  sub->footer(examples);
  sub->callback([name, &action] {
    action = [name] {
      if (name->empty())
        print_table();
      else
        print_material(io::find_material(*name, "materials"));
      return 0;
    };
  });
}

}  // namespace surf::cli
