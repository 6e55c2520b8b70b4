// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/library_parameters.h"

#include <fmt/format.h>

#include <algorithm>

#include "common_parameters.h"
#include "surf/core/error.h"
#include "surf/core/some_parameters.h"
#include "surf/core/units.h"
#include "surf/core/words.h"
#include "surf/mc/geometry/beam.h"
#include "surf/mc/physics/physics.h"
#include "surf/mc/simulate.h"

namespace surf::workflow {
namespace {

std::string text_of(const std::vector<double>& energies_ev) {
  std::string text;
  for (const double energy : energies_ev)
    text += (text.empty() ? "" : ",") + format_value(energy, Unit::ev);
  return text;
}

std::size_t whole_pages(std::int64_t cascades) {
  constexpr auto page = static_cast<std::int64_t>(mc::CascadeLibrary::page_cascades);
  return static_cast<std::size_t>((cascades + page - 1) / page * page);
}

}  // namespace

void describe(ParameterVisitor& visit, LibraryParameters& p) {
  visit.form(
      {.name = "library.energy",
       .help = "Energies of the beam, one or several, 100eV to 30keV",
       .form = "ENERGY,..."},
      [&] { return text_of(p.energies_ev); },
      [&](std::string_view text, const std::string& subject) {
        p.energies_ev = parse_energies_ev(text, subject);
      });
  visit(p.cascades, {.name = "library.cascades",
                     .help = "Primaries in each library, rounded up to whole 2048s",
                     .limits = within(1, 100'000'000),
                     .otherwise = "as many as the accuracy takes"});
  visit(p.accuracy, {.name = "library.accuracy",
                     .help = "Accuracy of images that begin with so many cascades, (2/accuracy)^2 "
                             "and not below 10000",
                     .unit = Unit::share,
                     .limits = within(1e-4, 1),
                     .otherwise = "10000 cascades"});
  describe_some(visit, p.simulation,
                {{"simulation.physics",
                  "Changes to the physics, as for simulate; each choice has libraries of its own"},
                 {"simulation.cutoff"},
                 {"simulation.seed"}});
  describe_cache(visit, p.cache);
  describe_threads(visit, p.threads);
}

std::vector<double> parse_energies_ev(std::string_view text, const std::string& subject) {
  const Parameter energy{.name = "energy",
                         .help = "",
                         .unit = Unit::ev,
                         .limits = within(mc::min_beam_energy_ev, mc::max_beam_energy_ev)};
  std::vector<double> energies;
  for (const double value : parse_values(text, energy, subject))
    if (std::ranges::find(energies, value) == energies.end()) energies.push_back(value);
  return energies;
}

std::size_t cascades_of(const LibraryParameters& p) {
  if (p.cascades && p.accuracy)
    throw UsageError("`library.cascades`", "the accuracy gives their number",
                     "Leave out one of the two");
  if (p.cascades) return whole_pages(*p.cascades);
  mc::SimulationOptions simulation;
  if (p.accuracy) simulation.budget = mc::Accuracy{*p.accuracy};
  return mc::library_size(simulation, mc::electrons_of(simulation.budget));
}

std::vector<mc::CascadeSettings> libraries_of(const LibraryParameters& p,
                                              const mc::Material& material) {
  std::vector<mc::CascadeSettings> libraries;
  for (const double energy_ev : p.energies_ev) {
    mc::Beam beam;
    beam.energy_ev = energy_ev;
    mc::validate(beam);
    const mc::Physics& physics = p.simulation.physics;
    mc::validate(physics, energy_ev);
    const double inside_ev = physics.barrier != mc::BarrierModel::off ? material.barrier_ev : 0;
    libraries.push_back({material, physics, energy_ev + inside_ev, p.simulation.seed});
    mc::CascadeLibrary check(libraries.back());
  }
  return libraries;
}

}  // namespace surf::workflow
