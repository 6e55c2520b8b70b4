// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "bound_parameters.h"
#include "commands.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/plot.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/physics/dielectric_data.h"
#include "surf/mc/physics/element.h"
#include "surf/mc/physics/full_penn.h"
#include "surf/mc/physics/material_doubts.h"
#include "surf/workflow/material_plot.h"
#include "surf/workflow/step_record.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* materials_examples = R"(Examples:
  semsurf materials                                    the table
  semsurf materials Si                                 every number of silicon, with its source
  semsurf materials Si --plot si.svg                   its losses, free paths and yields, drawn
  semsurf materials nitride --materials mine.toml      your own, and what is estimated
A file of your own materials:
  [[material]]
  name = "nitride"
  formula = "Si3N4"
  density_g_cm3 = 3.17
  band_gap_ev = 5.3)";

const std::string* estimate_of(const mc::Material& m, const char* field) {
  for (const mc::EstimatedValue& e : m.estimates)
    if (e.field == field) return &e.rule;
  return nullptr;
}

const char* how_fitted(const mc::Material& m) {
  if (m.loss_join_fitted) return "fitted";
  return estimate_of(m, "loss_join_ev") ? "estimated" : "unfitted";
}

void print_table(const std::vector<mc::Material>& materials) {
  std::size_t width = 8;
  for (const mc::Material& m : materials) width = std::max(width, m.name.size());
  print("{:<{}}  {:>7}  {:>9}  {:>11}  {:>11}  {:>8}  {}\n", "name", width, "g/cm^3", "work, eV ",
        "barrier, eV ", "plasmon, eV ", "E_b, eV ", "SE yield");
  bool any = false;
  for (const mc::Material& m : materials) {
    const auto number = [&](double value, const char* field) {
      const bool estimated = estimate_of(m, field);
      any |= estimated;
      return fmt::format("{:.4g}{}", value, estimated ? "*" : " ");
    };
    print("{:<{}}  {:>7.5g}  {:>9}  {:>12}  {:>12}  {:>8}  {}\n", m.name, width, m.density_g_cm3,
          number(m.work_function_ev, "work_function_ev"), number(m.barrier_ev, "barrier_ev"),
          m.plasmon_ev > 0 ? number(m.plasmon_ev, "plasmon_ev") : "none ",
          number(m.loss_join_ev, "loss_join_ev"), how_fitted(m));
  }
  if (any) print("* estimated; 'semsurf materials NAME' says how\n");
}

void print_value(const char* label, const std::string& value, const char* unit) {
  print("  {:<38} {}{}{}\n", label, value, *unit ? " " : "", unit);
}

// Its sums tell how far an energy-loss function can be trusted.
void print_dielectric(const mc::Material& m) {
  const mc::DielectricData& data = *m.dielectric;
  const auto line = [&](const char* label, double value, const char* unit, const char* field) {
    print_value(label, fmt::format("{:.5g}", value), unit);
    for (const mc::EstimatedValue& e : data.estimates)
      if (e.field == field) print("    estimated: {}\n", e.rule);
  };
  const mc::EnergyLossFunction elf =
      data.band.gap_ev > 0 ? data.elf.above(data.band.gap_ev) : data.elf;
  print("  with inelastic=dielectric, energies from the bottom of the filled band:\n");
  print_value("  energy-loss function",
              fmt::format("{:g} to {:g}", elf.lowest_ev(), elf.highest_ev()), "eV");
  print("    {}\n", elf.source());
  const double screening = elf.screening_sum(), complete = data.expected_screening_sum;
  double z = 0;
  for (const mc::Constituent& c : m.constituents)
    z += c.atomic_number * mc::atoms_per_formula_unit(m, c);
  const double electrons = elf.electron_sum(mc::formula_units_per_nm3(m));
  print_value("    screening sum", fmt::format("{:.3f}, {:.3f} if complete", screening, complete),
              "");
  print_value("    electrons by the f-sum", fmt::format("{:.1f}, {:.4g} if complete", electrons, z),
              "");
  line("  filled band", data.band.filled_ev, "eV", "filled_band_ev");
  if (data.band.gap_ev > 0) line("  gap", data.band.gap_ev, "eV", "gap_ev");
  line("  highest filled state to vacuum", data.vacuum_ev, "eV", "vacuum_ev");
  line("  lattice constant", data.lattice_nm, "nm", "lattice_nm");
  for (const mc::AcousticBranch& b : data.acoustic) {
    line(data.acoustic.size() == 1    ? "  sound"
         : &b == data.acoustic.data() ? "  sound, longitudinal"
                                      : "  sound, transverse",
         b.speed_m_s, "m/s", "sound_m_s");
    if (b.deformation_ev > 0) line("    deformation potential", b.deformation_ev, "eV", "");
  }
  if (data.resistivity_ohm_m > 0)
    line("  resistivity, for the deformation", data.resistivity_ohm_m, "ohm m", "");
  else if (std::ranges::any_of(data.acoustic,
                               [](const mc::AcousticBranch& b) { return !(b.deformation_ev > 0); }))
    for (const mc::EstimatedValue& e : data.estimates)
      if (e.field == "deformation_ev") print("    deformation potential estimated: {}\n", e.rule);
  for (const mc::OpticalMode& mode : data.optical)
    line("  optical phonons", mode.energy_ev, "eV", "optical_phonons");
  if (data.trap_per_nm > 0)
    print_value(
        "  polaron traps",
        fmt::format("{:g} per nm, falling by e every {:g} eV", data.trap_per_nm, data.trap_ev), "");
  if (!data.sources.empty()) print("    {}\n", data.sources);
  print("  {:>10}  {:>14}  {:>16}\n", "energy", "free path, nm", "loss, eV/nm");
  const mc::FullPenn losses(data);
  for (const double energy_ev : {30.0, 100.0, 300.0, 1000.0, 3000.0, 10000.0, 30000.0}) {
    const double inside = energy_ev + data.barrier_ev();
    print("  {:>10}  {:>14.3g}  {:>16.3g}\n", fmt::format("{:g} eV", energy_ev),
          1 / losses.inverse_mean_free_path_per_nm(inside),
          losses.stopping_power_ev_per_nm(inside));
  }
  const auto off = [](double value, double expected) { return std::fabs(value / expected - 1); };
  if (off(screening, complete) > 0.1 || off(electrons, z) > 0.1)
    print_warning(fmt::format("the energy-loss function of {} breaks a sum rule by {:.0f} %",
                              m.name, 100 * std::max(off(screening, complete), off(electrons, z))));
}

void print_material(const mc::Material& m) {
  const auto line = [&](const char* label, double value, const char* unit, const char* field) {
    const std::string* const rule = estimate_of(m, field);
    print_value(label, rule ? fmt::format("{:.5g}", value) : format_exact(value), unit);
    if (rule) print("    estimated: {}\n", *rule);
  };
  print("{}\n", m.name);
  line("density", m.density_g_cm3, "g/cm^3", "density_g_cm3");
  line("work function W", m.work_function_ev, "eV", "work_function_ev");
  line("surface barrier U0", m.barrier_ev, "eV", "barrier_ev");
  line("valence electrons per formula unit", m.valence_electrons, "", "valence_electrons");
  if (m.plasmon_ev > 0) line("plasmon energy", m.plasmon_ev, "eV", "plasmon_ev");
  else print_value("plasmon energy", "none", "");
  line("E_b, where the low-energy loss joins", m.loss_join_ev,
       m.loss_join_fitted ? "eV (fitted to measured SE yields)" : "eV (unfitted)", "loss_join_ev");
  for (const mc::Constituent& c : m.constituents) {
    print("  {}, Z = {}, {:.4g} % of the mass, {:.4g} per formula unit\n",
          mc::element(c.atomic_number).symbol, c.atomic_number, 100 * c.weight_fraction,
          mc::atoms_per_formula_unit(m, c));
    print_value("  atomic weight", format_exact(c.atomic_weight), "g/mol");
    print_value("  mean ionization energy J", fmt::format("{:.5g}", c.mean_ionization_ev), "eV");
    print_value("  atoms", fmt::format("{:.4g}", mc::number_density_per_nm3(m, c)), "per nm^3");
    print_value("  Mott table",
                mc::has_mott_table(c.atomic_number) ? "yes" : "no: use --physics elastic=browning",
                "");
  }
  if (!m.sources.empty()) print("  sources: {}\n", m.sources);
  print_dielectric(m);
  if (const auto doubt = mc::doubt_of_a_metal(m)) print_warning(*doubt);
}

struct MaterialsOutput {
  std::string plot;
};

void describe(ParameterVisitor& visit, MaterialsOutput& output) {
  visit(output.plot, {.name = "materials.plot",
                      .help = "Chart of one material's losses, free paths and yields: .svg .png",
                      .form = "FILE",
                      .file = FileRole::written});
}

int print_materials(const io::MaterialChoice& choice, const MaterialsOutput& output) {
  io::MaterialLibrary library;
  std::vector<std::string> notes;
  for (const std::string& file : choice.files) library.read(file, notes);
  for (const std::string& note : notes) print_note(note);
  if (choice.name.empty()) {
    if (!output.plot.empty())
      throw UsageError("`materials.plot`", "a chart shows one material",
                       "Name one: semsurf materials Si --plot si.svg");
    print_table(library.all());
    return 0;
  }
  const mc::Material& material = library.find(choice.name, "materials");
  if (!output.plot.empty()) io::check_plot_target(output.plot);
  print_material(material);
  if (output.plot.empty()) return 0;
  Watched watched(true);
  io::Plot plot = workflow::plot_material(material, {.watch = watched.watch()});
  watched.clear();
  plot.metadata = workflow::step_record("materials", workflow::records_of(choice),
                                        {choice.files.begin(), choice.files.end()});
  io::write_plot(output.plot, plot);
  print("written    {}\n", output.plot);
  return 0;
}

}  // namespace

void add_materials(CLI::App& app, Action& action) {
  const auto bound = std::make_shared<BoundParameters>();
  CLI::App* sub = app.add_subcommand("materials", "The materials and their numbers");
  bound->looks["specimen.material"] = {
      .name = "NAME", .help = "Material to show in full, with sources", .positional = true};
  bound->add<io::MaterialChoice>(*sub, "Options");
  bound->add<MaterialsOutput>(*sub, "Options");
  sub->footer(materials_examples);
  sub->callback([bound, &action] {
    action = [bound] {
      io::MaterialChoice choice;
      MaterialsOutput output;
      bound->apply(choice), bound->apply(output);
      return print_materials(choice, output);
    };
  });
}

}  // namespace surf::cli
