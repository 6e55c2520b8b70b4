// SPDX-License-Identifier: GPL-3.0-or-later
// Simulations over a grid of settings.
#include <fmt/format.h>

#include <algorithm>

#include "specimens.h"
#include "surf/core/error.h"
#include "surf/io/cache.h"
#include "surf/io/overlaps.h"
#include "surf/workflow/specimen_reader.h"
#include "surf/workflow/sweep_grid.h"
#include "surf/workflow/sweep_job.h"

namespace surf::python {
namespace {

namespace fs = std::filesystem;

/// Parameters that can be varied: of the specimen and of what is asked of it, files apart.
bool can_vary(const std::string& parameter) {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names;
    const auto add = [&](const Parameter& about, Field&) { names.push_back(about.name); };
    io::SpecimenRequest specimen;
    for_each_parameter(specimen, add);
    mc::SimulationRequest request;
    for_each_parameter(request, add);
    return names;
  }();
  for (const char* fixed : {"specimen.input", "specimen.materials", "simulation.time"})
    if (parameter == fixed) return false;
  return std::ranges::find(all, parameter) != all.end();
}

std::vector<std::string> values_of(py::handle given, const Keyword& keyword) {
  const std::string subject = fmt::format("vary['{}']", keyword.name);
  if (PyUnicode_Check(given.ptr()))
    return workflow::parse_sweep_values(given.cast<std::string>(), subject);
  if (!py::isinstance<py::iterable>(given))
    throw UsageError(subject, "it is no list",
                     "Give a list of values, or a text as '0deg:60deg:5deg'");
  std::vector<std::string> values;
  for (const py::handle one : py::iter(given)) {
    const std::vector<std::string> texts = texts_of(one, keyword);
    if (texts.size() != 1)
      throw UsageError(subject, "it holds what is no single value", "Give a list of values");
    values.push_back(texts.front());
  }
  if (values.empty()) throw UsageError(subject, "there is no value", "Give a list of values");
  return values;
}

struct Axes {
  std::vector<workflow::SweepAxis> axes;
  std::vector<std::string> parameters;
};

Axes axes_of(const Call& call) {
  const py::object vary = call["vary"];
  if (!PyDict_Check(vary.ptr()) || py::len(vary) == 0)
    throw UsageError("vary", "nothing varies",
                     "Give a dictionary, as {'energy': ['1keV', '2keV']}");
  Axes all;
  for (const auto& [name, values] : py::reinterpret_borrow<py::dict>(vary)) {
    const Keyword& keyword = call.keyword(py::str(name), "vary");
    if (!can_vary(keyword.parameter))
      throw UsageError("vary", fmt::format("'{}' cannot be varied", keyword.name),
                       "Vary what says how the specimen is, and how its image is taken");
    if (call.is_given(keyword.parameter))
      throw UsageError(fmt::format("`{}`", keyword.parameter), "vary has it, too",
                       "Leave one of them out");
    all.axes.push_back({keyword.name, values_of(values, keyword)});
    all.parameters.push_back(keyword.parameter);
  }
  return all;
}

std::vector<std::string> formats_of(const Call& call) {
  const py::object given = call["format"];
  if (given.is_none()) return {"exr"};
  if (PyUnicode_Check(given.ptr())) return {given.cast<std::string>()};
  return given.cast<std::vector<std::string>>();
}

workflow::SimulateJob make_run(const GivenTexts& given, const io::SpecimenRequest& like) {
  const auto apply = [&](auto& to) {
    read_parameters(to, [&](const Parameter& about, Field& field) { take(about, field, given); });
  };
  workflow::SimulateJob job;
  job.cache = io::cache_folder();
  apply(job);
  io::SpecimenRequest request = like;
  apply(request);
  request.inputs = like.inputs;
  job.scene = io::read_specimen(request, workflow::specimen_reader());
  apply(static_cast<mc::SimulationRequest&>(job.scene));
  job.command_line = "semsurf.sweep(...) in Python";
  return job;
}

workflow::SweepJob job_of(const Call& call) {
  workflow::SweepJob job;
  call.apply(job);
  if (job.folder.empty()) throw UsageError("`output`", "no folder is given", "Add `output=sweep`");
  job.command_line = "semsurf.sweep(...) in Python";
  auto request = call.told<io::SpecimenRequest>();
  io::ShapesInMemory shapes;
  add_specimen(call["specimen"], request, shapes);
  if (!shapes.meshes.empty() || shapes.field)
    throw UsageError("specimen", "it is in memory, and a sweep goes on from what files hold",
                     "Write it to a file first, or call semsurf.simulate in a loop");
  Axes axes = axes_of(call);
  const workflow::SweepGrid grid(axes.axes, "vary");
  for (const workflow::SweepAxis& axis : grid.axes()) job.axes.push_back(axis.name);
  for (std::size_t number = 0; number < grid.runs(); ++number) {
    workflow::SweepRun run;
    run.values = grid.values(number);
    GivenTexts given = call.given();
    for (std::size_t a = 0; a < axes.parameters.size(); ++a)
      given[axes.parameters[a]] = {run.values[a]};
    std::vector<std::string> files;
    for (const std::string& format : formats_of(call))
      files.push_back((job.folder / (grid.file_name(number) + "." + format)).string());
    fs::path record = files.back();
    io::refuse_strangers(files.back(), {record.replace_extension(".run.json")});
    given["output"] = files;
    run.make = [given, request] { return make_run(given, request); };
    job.runs.push_back(std::move(run));
  }
  for (const std::size_t i : grid.tried()) {
    const workflow::SimulateJob tried = job.runs[i].make();
    workflow::resolve_scan(tried.scene.scan, mc::extent(tried.scene.specimen), tried.scene.beam);
    mc::validate(tried.scene.physics, tried.scene.beam.energy_ev);
  }
  return job;
}

/// What a sweep says itself, and what is of checkpoints: finished runs are kept anyway.
std::vector<std::string> not_of_sweeps() {
  std::vector<std::string> names{"output"};
  workflow::SimulateJob job;
  for_each_parameter(job, [&](const Parameter& about, Field&) {
    for (const char* beginning : {"job.checkpoint", "job.restart"})
      if (about.name.starts_with(beginning)) names.push_back(about.name);
  });
  return names;
}

py::object sweep(const Call& call) {
  const workflow::SweepJob job = job_of(call);
  workflow::SweepSummary s;
  call.work([&](const workflow::Reporter& reporter) {
    s = workflow::run(job, reporter);
    if (!s.complete) throw Interrupted();
  });
  if (s.untrustworthy > 0)
    Call::warn(fmt::format("{} of {} runs missed their accuracy", s.untrustworthy, s.done));
  py::dict d;
  d["table"] = s.table.string();
  d["done"] = s.done;
  d["found"] = s.found;
  d["untrustworthy"] = s.untrustworthy;
  return findings(d);
}

}  // namespace

void add_sweep(py::module_& module) {
  Function f{.name = "sweep",
             .summary = "Simulations over a grid of settings: energies, tilts, focus."};
  f.details =
      "The folder gets an image for each combination, named by its values, and a table with their\n"
      "mean yields. Ctrl-C keeps what is done, and the same call goes on from there.";
  Argument specimen = specimen_argument;
  specimen.type = "PathLike | Sequence[PathLike]";
  specimen.help = "A scene file (TOML), or meshes and at most one height field, as files.";
  f.arguments = {specimen,
                 {"vary", "dict[str, str | Sequence]",
                  "What varies, by the names of keywords: a list, or a range as "
                  "'0deg:60deg:5deg'. All combinations are simulated.",
                  true},
                 {"format", "str | Sequence[str]", "Of the images: 'exr', 'tif', 'png', 'vti'."}};
  f.takes<workflow::SweepJob>()
      .takes<io::SpecimenRequest>({}, {"specimen.input"})
      .takes<workflow::SimulateJob>({}, not_of_sweeps());
  f.result_type = "Findings";
  f.result =
      "The file `table` (CSV: run, what varies as it was given, file, and for each detector the "
      "mean "
      "yield and its standard error), how many runs are `done`, and how many of them were `found` "
      "from before.";
  f.example = ">>> semsurf.sweep('mesa80.toml', vary={'tilt': [0, 30, 60]}, output='tilts')";
  define(module, f, sweep);
}

}  // namespace surf::python
