// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/sim/materials.h"
#include "arrays.h"
#include "data.h"
#include "surf/mc/physics/element.h"

namespace surf::python {
namespace {

py::object found_of(const mc::Material& m) {
  py::dict d;
  d["name"] = m.name;
  d["density_g_cm3"] = m.density_g_cm3;
  d["work_function_ev"] = m.work_function_ev;
  d["barrier_ev"] = m.barrier_ev;
  d["valence_electrons"] = m.valence_electrons;
  d["plasmon_ev"] = m.plasmon_ev;
  d["loss_join_ev"] = m.loss_join_ev;
  d["loss_join_fitted"] = m.loss_join_fitted;
  d["band_gap_ev"] = m.dielectric ? m.dielectric->band.gap_ev : 0.0;
  py::list constituents;
  for (const mc::Constituent& c : m.constituents) {
    py::dict one;
    one["symbol"] = mc::element(c.atomic_number).symbol;
    one["Z"] = c.atomic_number;
    one["atomic_weight"] = c.atomic_weight;
    one["weight_fraction"] = c.weight_fraction;
    one["mean_ionization_ev"] = c.mean_ionization_ev;
    constituents.append(findings(one));
  }
  d["constituents"] = constituents;
  py::dict estimates;
  for (const mc::EstimatedValue& e : m.estimates) estimates[py::str(e.field)] = e.rule;
  d["estimates"] = findings(estimates);
  d["sources"] = m.sources;
  return findings(d);
}

py::object materials(const Call& call) {
  const auto choice = call.told<io::MaterialChoice>();
  io::MaterialLibrary library;
  std::vector<std::string> notes;
  for (const std::string& file : choice.files) library.read(file, notes);
  Call::notes(notes);
  if (!choice.name.empty()) return found_of(library.find(choice.name, "`specimen.material`"));
  py::dict all;
  for (const mc::Material& material : library.all())
    all[py::str(material.name)] = found_of(material);
  return findings(all);
}

}  // namespace

void add_materials(py::module_& module) {
  Function f{.name = "materials", .summary = "The materials and their numbers."};
  f.result_type = "Findings";
  f.result =
      "All materials by name, or the one that is named: its numbers, which of them are estimates, "
      "and sources.";
  f.example = ">>> semsurf.materials(material='Si').density_g_cm3";
  f.is_long = false;
  define(module, f.takes<io::MaterialChoice>(), materials);
}

}  // namespace surf::python
