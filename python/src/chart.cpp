// SPDX-License-Identifier: GPL-3.0-or-later
// Time against error of every method.
#include <fmt/format.h>

#include "specimens.h"
#include "surf/core/error.h"
#include "surf/workflow/chain_chart_job.h"
#include "surf/workflow/chart_job.h"
#include "surf/workflow/specimen_reader.h"

namespace surf::python {
namespace {

py::object found_of(const workflow::ChartPoint& p) {
  py::dict d, rms;
  d["id"] = p.id;
  d["family"] = p.family;
  d["setting"] = p.setting;
  d["run_s"] = p.run_s;
  d["preparation_s"] = p.preparation_s;
  d["peak_bytes"] = p.peak_bytes;
  d["primaries"] = p.primaries;
  d["is_default"] = p.is_default;
  for (const workflow::ChartChannel& c : p.channels) rms[py::str(c.name)] = c.error.rms;
  d["rms"] = findings(rms);
  return findings(d);
}

py::object found_of(const workflow::ReconstructionPoint& p) {
  py::dict d;
  d["id"] = p.id;
  d["family"] = p.family;
  d["setting"] = p.setting;
  d["run_s"] = p.steps.back().run_s;
  d["preparation_s"] = p.preparation_s;
  d["rms_nm"] = p.steps.back().rms_nm;
  return findings(d);
}

py::object found_of(const workflow::RegistrationPoint& p) {
  py::dict d;
  d["id"] = p.id;
  d["family"] = p.family;
  d["offset_px"] = p.offset_px;
  d["offset_deg"] = p.offset_deg;
  d["draws"] = p.draws;
  d["right"] = p.right;
  d["wrong"] = p.wrong;
  d["median_px"] = p.median_px;
  d["median_s"] = p.median_s;
  return findings(d);
}

template <class Point>
py::list found_of_all(const std::vector<Point>& points) {
  py::list all;
  for (const Point& point : points) all.append(found_of(point));
  return all;
}

py::object of_sample(const Call& call, const std::string& folder) {
  workflow::ChainChartJob job;
  call.apply(job);
  job.sample = folder;
  job.command_line = "semsurf.chart(...) in Python";
  workflow::ChainChartSummary s;
  call.work([&](const workflow::Reporter& reporter) {
    s = workflow::run(job, reporter);
    if (!s.complete) throw Interrupted();
  });
  py::dict d;
  d["registrations"] = found_of_all(s.registrations);
  d["reconstructions"] = found_of_all(s.reconstructions);
  d["eroded_nm"] = s.eroded_nm;
  d["floor_nm"] = s.floor_nm;
  d["left_out"] = list_of(s.left_out);
  d["written"] = list_of(s.written);
  return findings(d);
}

py::object of_scene(const Call& call) {
  workflow::ChartJob job;
  call.apply(job);
  job.command_line = "semsurf.chart(...) in Python";
  auto request = call.told<io::SpecimenRequest>();
  io::ShapesInMemory shapes;
  add_specimen(call["specimen"], request, shapes);
  workflow::ChartSummary s;
  call.work([&](const workflow::Reporter& reporter) {
    job.scene = io::read_specimen(request, shapes, workflow::specimen_reader());
    for (const std::string& note : job.scene.notes) reporter.note(note);
    call.apply(static_cast<mc::SimulationRequest&>(job.scene));
    s = workflow::run(job, reporter);
    if (!s.complete) throw Interrupted();
  });
  py::dict d;
  d["points"] = found_of_all(s.points);
  py::list choices;
  for (const workflow::ChartChoice& c : s.choices) {
    py::dict one;
    one["accuracy"] = c.accuracy;
    one["reason"] = c.reason;
    one["id"] = c.id;
    one["fastest"] = c.fastest;
    one["ratio"] = c.ratio;
    one["met"] = c.met;
    choices.append(findings(one));
  }
  d["choices"] = choices;
  d["compared"] = s.compared;
  d["left_out"] = list_of(s.left_out);
  d["written"] = list_of(s.written);
  return findings(d);
}

py::object chart(const Call& call) {
  if (!call.is_given("output"))
    throw UsageError("`output`", "no folder is given", "Add `output=chart`");
  const py::object given = call["specimen"];
  if (!is_path(given) || !workflow::is_sample(path_of(given))) return of_scene(call);
  return of_sample(call, path_of(given));
}

}  // namespace

void add_chart(py::module_& module) {
  Function f{.name = "chart",
             .summary = "Time against error of every method, on a scene or a sample of yours."};
  f.details =
      "Of a folder that `sample` made, registration and reconstruction are charted instead.\n"
      "Charts and tables are written into the folder. Ctrl-C keeps what is done, and the same "
      "call\n"
      "goes on from there.";
  f.arguments = {specimen_argument};
  f.takes<workflow::ChartJob>()
      .takes<workflow::ChainChartJob>()
      .takes<io::SpecimenRequest>({}, {"specimen.input"})
      .takes<mc::SimulationRequest>(
          {}, {"beam.current", "beam.dwell", "simulation.electrons", "simulation.accuracy",
               "simulation.accuracy_floor", "simulation.time", "simulation.method",
               "simulation.mesh_tolerance", "simulation.detectors", "simulation.seed"});
  f.result_type = "Findings";
  f.result = "`points` with times and errors, `choices` of the program, files `written`.";
  define(module, f, chart);
}

}  // namespace surf::python
