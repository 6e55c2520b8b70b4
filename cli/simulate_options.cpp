// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate_options.h"

#include <algorithm>
#include <utility>

#include "common_options.h"
#include "surf/core/error.h"
#include "surf/io/cache.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* simulate_options_examples =
    R"(Units: bare lengths are nm, bare energies eV, bare angles degrees;
suffixes are allowed everywhere (pm A nm um mm m, eV keV MeV, deg rad mrad).

Any two of --size, --pixel-size and --region define the scan. With one the specimen's
extent gives the rest; with none it is 256 pixels across the longer side. Numbers given
here go before those of the scene file.

Channels of --channels: 'electrons' are the primaries that a pixel's value is the mean of.
'model' is how it got it: 1 direct, 2 replay, 3 difference (replay, as the difference to the
same cascades on a plane), 4 plane (proved to be flat as far as electrons reach: nothing is
left to simulate), 0 none. NAME.variance_left is the share of the scatter that is left by 3
and 4.

Examples:
  semsurf simulate cube.stl --substrate Si --tilt 40 -o cube.exr -o cube.png
  semsurf simulate grain.ply --unit um --material Au --energy 5keV --pixel-size 5nm -o grain.tif
  semsurf simulate samples/mesa80.toml --electrons 1000 --seed 2 -o mesa.vti
  semsurf simulate samples/mesa80.toml --accuracy 2% --channels model,electrons -o mesa.exr
  semsurf simulate samples/mesa80.toml --time 30s -o mesa.exr
  semsurf simulate samples/cube.toml --electrons 32 --estimate guided -o cube.exr
  semsurf simulate cube.stl --materials mine.toml --material nitride -o nitride.exr
  semsurf simulate scan.gwy --height-channel ZSensor -o sem.exr
  semsurf simulate afm.tif --height-pitch 2nm --height-unit 0.1nm --edge mirror -o sem.exr
  semsurf simulate cube.stl --size 64x64 --region -96,-96,96,96 \
      --physics elastic=browning,secondaries=off -o bse.exr)";

const std::vector<std::string> written{"output", "job.checkpoint",
                                       "job.restart"};  // beginnings of names

void set_looks(BoundParameters& p) {
  p.headings = {{"specimen", "Specimen"},
                {"beam", "Beam"},
                {"scan", "Scan"},
                {"scan.height_pitch", "Specimen"},
                {"scan.height_unit", "Specimen"},
                {"scan.height_channel", "Specimen"},
                {"simulation", "Simulation"},
                {"simulation.detectors", "Detectors, besides SE and BSE"},
                {"output.spectra", "Detectors, besides SE and BSE"},
                {"output.deposit", "Detectors, besides SE and BSE"},
                {"output.trajectories", "Detectors, besides SE and BSE"},
                {"output.trajectories_at", "Detectors, besides SE and BSE"},
                {"output", "Output"},
                {"job", "Long jobs: the same command goes on from where it was stopped"},
                {"job.threads", "Simulation"},
                {"job.cache", "Simulation"}};
  p.looks["specimen.input"] = {.name = "INPUT", .positional = true};
  p.looks["scan.height_pitch"] = {.former = {"--pitch"}};
  p.looks["scan.height_unit"] = {.former = {"--z-unit"}};
  p.looks["simulation.detectors"] = {.name = "--detector"};
  p.looks["output.png_channel"] = {.former = {"--channel"}};
  p.looks["output"] = {.name = "-o,--output"};
}

/// Which parameters of a job the struct has, but for those whose names begin so.
std::vector<std::string> names_without(const std::vector<std::string>& beginnings) {
  std::vector<std::string> names;
  workflow::SimulateJob job;
  for_each_parameter(job, [&](const Parameter& about, Field&) {
    for (const std::string& beginning : beginnings)
      if (about.name.starts_with(beginning)) return;
    names.push_back(about.name);
  });
  return names;
}

void print_notes(const std::vector<std::string>& notes, bool quiet) {
  if (quiet) return;
  for (const std::string& note : notes) print_note(note);
}

}  // namespace

void add_request_options(CLI::App& app, BoundParameters& parameters,
                         const std::vector<std::string>& without) {
  set_looks(parameters);
  parameters.add(app, "", io::SpecimenRequest{});
  std::vector<std::string> names;
  mc::SimulationRequest request;
  for_each_parameter(request, [&](const Parameter& about, Field&) {
    if (std::ranges::find(without, about.name) == without.end()) names.push_back(about.name);
  });
  parameters.add(app, "", request, names);
}

void add_simulate_settings(CLI::App& app, SimulateOptions& o) {
  set_looks(o.parameters);
  o.parameters.add(app, "", io::SpecimenRequest{});
  std::vector<std::string> names = names_without(written);
  names.insert(names.end(), {"output.channels", "output.png_channel"});
  o.parameters.add(app, "", workflow::SimulateJob{}, names);
  add_quiet_flag(app, o.quiet)->group("Output");
}

void add_simulate_options(CLI::App& app, SimulateOptions& o) {
  set_looks(o.parameters);
  o.parameters.add(app, "", io::SpecimenRequest{});
  o.parameters.add(app, "", workflow::SimulateJob{});
  app.add_flag("--dry-run", o.dry_run,
               "Simulate a part for ten seconds, and tell what the whole will take: rays, time, "
               "memory and disk;\n"
               "writes nothing but libraries")
      ->group("Long jobs: the same command goes on from where it was stopped");
  add_quiet_flag(app, o.quiet)->group("Output");
  app.footer(simulate_options_examples);
}

io::SceneFile read_scene(const GivenTexts& given, bool quiet, const io::BodyReader& read) {
  // Numbers first: a bad one should not wait for a large mesh to be read.
  mc::SimulationRequest numbers;
  BoundParameters::apply(numbers, given);
  io::SpecimenRequest specimen;
  BoundParameters::apply(specimen, given);
  io::SceneFile scene = io::read_specimen(specimen, read);
  print_notes(scene.notes, quiet);
  BoundParameters::apply(static_cast<mc::SimulationRequest&>(scene), given);
  return scene;
}

workflow::SimulateJob make_simulate_job(const GivenTexts& given, bool quiet,
                                        const std::string& command_line,
                                        const io::BodyReader& read) {
  workflow::SimulateJob job;
  job.cache = io::cache_folder();
  BoundParameters::apply(job, given);
  if (job.outputs.empty() && given.contains("specimen.input"))
    throw UsageError("`output`", "no output file is given", "Add -o image.exr");
  job.scene = read_scene(given, quiet, read);
  job.command_line = command_line;
  return job;
}

}  // namespace surf::cli
