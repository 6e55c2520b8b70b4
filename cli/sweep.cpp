// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>

#include "commands.h"
#include "exit_codes.h"
#include "file_uses.h"
#include "job_reporter.h"
#include "joined_team.h"
#include "options.h"
#include "simulate_options.h"
#include "surf/core/error.h"
#include "surf/core/nearest.h"
#include "surf/workflow/specimen_reader.h"
#include "surf/workflow/sweep_grid.h"
#include "surf/workflow/sweep_job.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* sweep_examples =
    R"(What can be varied: whatever the groups Specimen, Beam, Scan, Simulation and Detectors have, files apart.
Values are those of the options of the same name: a list with commas, or FROM:TO:STEP.

FOLDER gets an image for each combination, named by its values, and sweep.csv with their mean
yields. Stop when you like: the same command goes on from there. Another grid needs another folder.
--part 3/16 does every 16th run from the third on: a job array does all parts, and 'semsurf sweep join'
makes the table. Under mpirun each process does whole runs, and they share large ones.
All other options are those of 'semsurf simulate'.

Examples:
  semsurf sweep samples/mesa80.toml --vary energy=500eV,1keV,2keV --vary tilt=0deg:60deg:5deg -o mesa
  semsurf sweep samples/flat.toml --vary tilt=0:80:10 --accuracy 2% -o yields
  semsurf sweep samples/mesa80.toml --vary seed=1:16:1 --part 3/16 -o seeds   a job of an array
  mpirun -n 4 semsurf sweep samples/mesa80.toml --vary tilt=0deg:60deg:5deg -o tilts)";

struct SweepArguments {
  SimulateOptions simulate;
  BoundParameters bound;
};

/// What is run.
struct Runs {
  std::vector<std::string> vary;     ///< "energy=500eV,1keV"
  std::vector<std::string> formats;  ///< of the images
};

void describe(ParameterVisitor& visit, Runs& runs) {
  describe_texts(visit, runs.vary,
                 {.name = "sweep.vary",
                  .help = "Parameter to vary, as energy=500eV,1keV or tilt=0deg:60deg:5deg; all "
                          "combinations are done",
                  .form = "NAME=VALUES"});
  visit(runs.formats, {.name = "sweep.format",
                       .help = "Format of the images",
                       .otherwise = "exr",
                       .form = "exr|tif|png|vti"});
}

/// SweepArguments of `simulate` that can be varied, without dashes, and the parameters that they
/// stand for.
const std::map<std::string, std::string>& varied_parameters() {
  static const std::map<std::string, std::string> all = [] {
    std::map<std::string, std::string> known;
    const auto add = [&](const Parameter& about, Field&) {
      known[option_name(about.name).substr(2)] = about.name;
    };
    io::SpecimenRequest specimen;
    for_each_parameter(specimen, add);
    mc::SimulationRequest request;
    for_each_parameter(request, add);
    for (const char* fixed : {"input", "time", "materials"}) known.erase(fixed);
    return known;
  }();
  return all;
}

std::string parameter_of(std::string name) {
  std::ranges::replace(name, '_', '-');  // as keys of scene files have it
  const auto& all = varied_parameters();
  if (const auto found = all.find(name); found != all.end()) return found->second;
  const std::string guess = nearest(name, names_to_vary());
  throw UsageError("--vary", fmt::format("'{}' cannot be varied", name),
                   guess.empty() ? "'semsurf sweep --help' lists what can"
                                 : fmt::format("Did you mean {}?", guess));
}

workflow::SweepAxis parse_axis(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw UsageError("--vary", fmt::format("'{}' names no values", text),
                     "Write NAME=VALUE,VALUE or NAME=FROM:TO:STEP");
  const std::string name = text.substr(0, equals);
  return {name, workflow::parse_sweep_values(text.substr(equals + 1), "--vary " + name)};
}

std::vector<io::FileUse> inputs_of(const SweepArguments& o) {
  std::vector<io::FileUse> inputs;
  const GivenTexts& given = o.simulate.parameters.given();
  for (const auto& [option, parameter] :
       {std::pair{"INPUT", "specimen.input"}, {"--materials", "specimen.materials"}})
    if (const auto files = given.find(parameter); files != given.end())
      for (const std::string& file : files->second)
        std::ranges::copy(files_read(option, file), std::back_inserter(inputs));
  return inputs;
}

workflow::SweepJob make_sweep(const SweepArguments& o, const std::string& command_line) {
  workflow::SweepJob job;
  Runs what;
  o.bound.apply(job), o.bound.apply(what);
  if (job.folder.empty()) throw UsageError("`output`", "no folder is given", "Add `output=sweep`");
  if (what.vary.empty())
    throw UsageError("--vary", "nothing varies", "Add --vary energy=500eV,1keV, say");
  job.command_line = command_line;
  std::vector<workflow::SweepAxis> axes;
  for (const std::string& text : what.vary) {
    axes.push_back(parse_axis(text));
    job.axes.push_back(axes.back().name);
  }
  const workflow::SweepGrid grid(std::move(axes), "--vary");
  const std::vector<std::string> formats =
      what.formats.empty() ? std::vector<std::string>{"exr"} : what.formats;
  std::vector<io::FileUse> outputs{{"--output", job.folder / "sweep.csv", {}},
                                   {"--output", job.folder / "records", {}}};
  for (std::size_t number = 0; number < grid.runs(); ++number) {
    workflow::SweepRun run;
    run.values = grid.values(number);
    GivenTexts given = o.simulate.parameters.given();
    for (std::size_t a = 0; a < grid.axes().size(); ++a)
      given[parameter_of(grid.axes()[a].name)] = {run.values[a]};
    std::vector<std::string>& files = given["output"];
    for (const std::string& format : formats) {
      files.push_back((job.folder / (grid.file_name(number) + "." + format)).string());
      outputs.push_back({"--output", files.back(), {}});
    }
    std::filesystem::path record = files.back();
    io::refuse_strangers(files.back(), {record.replace_extension(".run.json")});
    // Each process looks at every specimen, so each reads them; they are shared when they are
    // traced.
    run.make = [given, command_line] {
      return make_simulate_job(given, true, command_line,
                               workflow::specimen_reader(nullptr, processes_here()));
    };
    job.runs.push_back(std::move(run));
  }
  io::refuse_overlaps(inputs_of(o), outputs);
  for (const std::size_t i : grid.tried()) {
    const workflow::SimulateJob tried = job.runs[i].make();
    workflow::resolve_scan(tried.scene.scan, mc::extent(tried.scene.specimen), tried.scene.beam);
    mc::validate(tried.scene.physics, tried.scene.beam.energy_ev);
  }
  return job;
}

int sweep(const SweepArguments& o, const std::string& command_line) {
  workflow::SweepJob job;
  workflow::together(team(), [&] { job = make_sweep(o, command_line); });
  workflow::SweepSummary s;
  const bool quiet = o.simulate.quiet || !workflow::leads(team());
  {
    JobReporter reporter(quiet);
    const auto tell = [&](std::size_t run, const std::vector<workflow::SweepYield>& yields) {
      if (quiet) return;
      reporter.clear();
      std::string line = fmt::format("{:>5}/{}", run + 1, job.runs.size());
      for (const std::string& value : job.runs[run].values) line += fmt::format("  {:>8}", value);
      for (const workflow::SweepYield& y : yields)
        line += fmt::format("  {} {:.4f} ± {:.4f}", y.detector, y.mean, y.standard_error);
      print("{}\n", line);
      flush();
    };
    s = workflow::run(job, reporter, tell, team());
  }
  if (!s.complete) {
    print_note(fmt::format("stopped after {} runs, kept in {}; the same command goes on from there",
                           s.done, job.folder.string()));
    return exit_interrupted;
  }
  if (!quiet) {
    if (s.found > 0) print("{} runs were there before\n", s.found);
    print("written {}\n        images and records of {} runs in {}\n", s.table.string(), s.done,
          job.folder.string());
  }
  return s.untrustworthy > 0 ? exit_untrustworthy : 0;
}

CLI::App* add_join(CLI::App& app, Action& action) {
  const auto folders = std::make_shared<std::vector<std::string>>();
  CLI::App* sub = app.add_subcommand("join", "One table from the parts of a sweep");
  with_role(sub->add_option("FOLDER", *folders, "Folders that 'semsurf sweep --part' wrote to")
                ->type_name("FOLDER"),
            FileRole::none);
  sub->footer("Writes sweep.csv into the first folder.\n\nExample:\n  semsurf sweep join mesa");
  sub->callback([folders, &action] {
    action = [folders] {
      const auto table = workflow::join_sweep({folders->begin(), folders->end()});
      print("written {}\n", table.string());
      return 0;
    };
  });
  return sub;
}

}  // namespace

std::vector<std::string> names_to_vary() {
  std::vector<std::string> names;
  for (const auto& [name, parameter] : varied_parameters()) names.push_back(name);
  return names;
}

void add_sweep(CLI::App& app, Action& action, const std::string& command_line) {
  const auto options = std::make_shared<SweepArguments>();
  CLI::App* sub = app.add_subcommand(
      "sweep", "Simulations over a grid of settings: energies, tilts, focus ...");
  options->bound.looks["output"] = {.name = "-o,--output"};
  options->bound.add<Runs>(*sub, "Sweep", {}, {"sweep.vary"});
  options->bound.add<workflow::SweepJob>(*sub, "Sweep");
  options->bound.add<Runs>(*sub, "Sweep", {}, {"sweep.format"});
  add_simulate_settings(*sub, options->simulate);
  sub->footer(sweep_examples);
  add_join(*sub, action)->group("Commands");
  sub->callback([sub, options, &action, command_line] {
    if (!sub->get_subcommands().empty()) return;
    action = [options, command_line] { return sweep(*options, command_line); };
  });
}

void add_former_join(CLI::App& app, Action& action) { add_join(app, action)->group(""); }

}  // namespace surf::cli
