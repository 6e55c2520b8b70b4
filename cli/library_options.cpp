// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common_options.h"
#include "library.h"
#include "options.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/cache.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/beam.h"
#include "surf/mc/simulate.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr std::int64_t most_cascades = 100'000'000;

std::size_t whole_pages(std::int64_t cascades) {
  constexpr auto page = static_cast<std::int64_t>(mc::CascadeLibrary::page_cascades);
  return static_cast<std::size_t>((cascades + page - 1) / page * page);
}

double parse_accuracy(const std::string& text) {
  const double value = parse_share(text, "--accuracy");
  if (!(value >= 1e-4 && value <= 1))
    throw UsageError("--accuracy", fmt::format("'{}' is outside 0.01% to 100%", text),
                     "Write --accuracy 1%");
  return value;
}

std::size_t number_of_cascades(const LibraryOptions& o) {
  if (o.cascades && o.accuracy)
    throw UsageError("--cascades", "the accuracy gives their number", "Leave out one of the two");
  if (o.cascades) return whole_pages(parse_whole(*o.cascades, "--cascades", 1, most_cascades));
  mc::SimulationOptions simulation;
  if (o.accuracy) simulation.budget = mc::Accuracy{parse_accuracy(*o.accuracy)};
  return mc::library_size(simulation, mc::electrons_of(simulation.budget));
}

}  // namespace

void add_cache_option(CLI::App& app, LibraryOptions& o) {
  app.add_option("--cache", o.cache, "Folder that libraries are kept in ($SEMSURF_CACHE, ~/.cache/semsurf)")
      ->type_name("FOLDER");
}

void add_library_options(CLI::App& app, LibraryOptions& o) {
  app.add_option("MATERIAL", o.materials, "Material that the electrons move in")->type_name("MATERIAL");
  app.add_option("--energy", o.energy, "Energy of the beam, one or several, 100eV to 30keV (1keV)")
      ->type_name("ENERGY,...");
  app.add_option("--cascades", o.cascades, "Primaries in each library, rounded up to whole 2048s")
      ->type_name("N");
  app.add_option("--accuracy", o.accuracy,
                 "Accuracy of images that begin with so many cascades: (2/accuracy)^2, not\n"
                 "below 10000, which is their number where neither is given")
      ->type_name("SHARE");
  app.add_option("--physics", o.physics, "Changes to the physics, as for simulate; each choice has libraries of its "
                                        "own")
      ->type_name("KEY=VALUE,...");
  app.add_option("--cutoff", o.cutoff, "Energy inside the material where tracking stops, as for "
                                       "simulate")->type_name("ENERGY");
  app.add_option("--seed", o.seed, "Seed of the random numbers, as for simulate (1)")->type_name("N");
  add_materials_option(app, o.material_files);
  add_threads_option(app, o.threads);
  add_quiet_flag(app, o.quiet);
  add_cache_option(app, o);
}

std::vector<double> parse_energies_ev(const std::string& text) {
  std::vector<double> energies;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    const double energy = parse_energy_ev(text.substr(from, comma - from), "--energy");
    if (std::find(energies.begin(), energies.end(), energy) == energies.end())
      energies.push_back(energy);
    from = comma + 1;
  }
  return energies;
}

std::string library_title(const std::string& material, double beam_energy_ev) {
  return fmt::format("{} at {}", material, format_energy(beam_energy_ev));
}

LibraryRequest read_library_options(const LibraryOptions& o) {
  LibraryRequest request;
  if (o.materials.empty())
    throw UsageError("library", "no material is given", "Name one or several, as Si Au");
  request.energies_ev = o.energy ? parse_energies_ev(*o.energy) : std::vector{mc::Beam{}.energy_ev};
  request.cascades = number_of_cascades(o);
  request.threads = parse_threads(o.threads);
  request.cache = io::cache_folder(o.cache.value_or(""));
  mc::CascadeSettings settings;
  if (o.seed) settings.seed = parse_seed(*o.seed, "--seed");
  if (o.physics) mc::parse_physics(*o.physics, settings.physics);
  if (o.cutoff) settings.physics.cutoff_ev = parse_energy_ev(*o.cutoff, "--cutoff");

  io::MaterialLibrary materials;
  std::vector<std::string> notes;
  for (const std::string& file : o.material_files) materials.read(file, notes);
  for (const std::string& note : notes)
    if (!o.quiet) print_note(note);
  for (const std::string& name : o.materials) {
    settings.material = materials.find(name, "library");
    for (const double energy_ev : request.energies_ev) {
      mc::Beam beam;
      beam.energy_ev = energy_ev;
      mc::validate(beam);
      mc::validate(settings.physics, energy_ev);
      const bool barrier = settings.physics.barrier != mc::BarrierModel::off;
      settings.start_energy_ev = energy_ev + (barrier ? settings.material.barrier_ev : 0);
      mc::CascadeLibrary check(settings);
      request.libraries.push_back(settings);
    }
  }
  return request;
}

}  // namespace surf::cli
