// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <utility>

#include "acceptances.h"
#include "arrays.h"
#include "specimens.h"
#include "surf/core/error.h"
#include "surf/io/cache.h"
#include "surf/io/sim/specimen_in_memory.h"
#include "surf/io/tracks_file.h"
#include "surf/workflow/dry_run.h"
#include "surf/workflow/simulate_job.h"
#include "surf/workflow/specimen_reader.h"

namespace surf::python {
namespace {

py::list tracks_of(const std::vector<Track>& tracks) {
  py::list all;
  for (const Track& track : tracks) {
    py::dict d;
    py::array_t<double> points({static_cast<py::ssize_t>(track.points_nm.size()), py::ssize_t{3}});
    for (std::size_t i = 0; i < track.points_nm.size(); ++i) {
      double* const row = points.mutable_data(static_cast<py::ssize_t>(i), 0);
      row[0] = track.points_nm[i].x, row[1] = track.points_nm[i].y, row[2] = track.points_nm[i].z;
    }
    d["points"] = points;
    d["energies"] = array_of(track.energy_ev);
    d["kind"] = name_of(track.kind);
    d["secondary"] = track.secondary;
    d["electron"] = track.electron;
    d["number"] = track.number;
    d["parent"] = track.parent;
    d["generation"] = track.generation;
    d["materials"] = array_of(track.material);
    all.append(findings(d));
  }
  return all;
}

/// What is not text: the specimen's shapes, and detectors that are functions.
struct InMemory {
  io::ShapesInMemory shapes;
  std::vector<mc::Detector> detectors;
};

/// The job's scene, with notes about it.
void take_scene(workflow::SimulateJob& job, const io::SpecimenRequest& request,
                const InMemory& memory, const Call& call, const workflow::Reporter& reporter) {
  job.scene = io::read_specimen(request, memory.shapes, workflow::specimen_reader());
  for (const std::string& note : job.scene.notes) reporter.note(note);
  call.apply(static_cast<mc::SimulationRequest&>(job.scene));
  job.scene.detectors.insert(job.scene.detectors.end(), memory.detectors.begin(),
                             memory.detectors.end());
}

class Simulation {
 public:
  explicit Simulation(workflow::SimulateJob job) : job_(std::move(job)) {}

  void run(const io::SpecimenRequest& request, const InMemory& memory, const Call& call,
           const workflow::Reporter& reporter) {
    take_scene(job_, request, memory, call, reporter);
    summary_ = workflow::run(job_, reporter);
    for (const std::filesystem::path& file : summary_.written)
      if (file.string().ends_with(".tracks.vtp")) summary_.tracks = io::read_tracks(file);
  }

  py::object result();

 private:
  workflow::SimulateJob job_;
  workflow::SimulateSummary summary_;
};

py::object Simulation::result() {
  workflow::SimulateSummary& s = summary_;
  if (s.image.channels.empty()) return py::none();
  Picture picture;
  picture.image = std::move(s.image);
  picture.record = picture.image.metadata;
  py::dict yields, found;
  for (std::size_t d = 0; d < s.statistics.yields.size(); ++d)
    yields[py::str(s.result.detectors[d].name)] =
        measured(s.statistics.yields[d].mean, s.statistics.yields[d].standard_error);
  found["yields"] = findings(yields);
  found["method"] = mc::name(s.choice.method);
  found["method_reason"] = s.choice.reason;
  found["electrons"] = s.statistics.mean_electrons;
  found["seconds"] = s.result.seconds;
  found["complete"] = s.result.complete;
  found["pixels_missed"] = s.statistics.missed;
  if (s.charging) found["charging"] = describe(*s.charging);
  if (!s.tracks.empty()) found["tracks"] = tracks_of(s.tracks);
  py::list written, warnings;
  for (const auto& file : s.written) written.append(file.string());
  for (const std::string& warning : s.warnings) warnings.append(with_keywords(warning));
  found["written"] = written;
  found["warnings"] = warnings;
  picture.found = findings(found);
  return object_of(std::move(picture));
}

py::object foretold(workflow::SimulateJob job, const io::SpecimenRequest& request,
                    const InMemory& memory_of_caller, const Call& call) {
  constexpr double seconds = 10;
  workflow::DryRun dry;
  call.work([&](const workflow::Reporter& reporter) {
    take_scene(job, request, memory_of_caller, call, reporter);
    dry = workflow::dry_run(std::move(job), 1, seconds, reporter);
  });
  py::dict d, memory, disk;
  d["size"] = py::make_tuple(dry.scan.width, dry.scan.height);
  d["method"] = mc::name(dry.choice.method);
  d["method_reason"] = dry.choice.reason;
  d["seconds"] = measured(dry.expected_s, dry.standard_error_s);
  d["threads"] = dry.threads;
  d["memory_bytes"] = dry.memory_bytes;
  for (const workflow::MemoryNeed& need : dry.memory) memory[py::str(need.what)] = need.bytes;
  for (const workflow::DiskNeed& need : dry.disk) disk[py::str(need.what)] = need.bytes;
  d["memory"] = findings(memory);
  d["disk"] = findings(disk);
  py::list warnings;
  for (const std::string& warning : dry.warnings) warnings.append(with_keywords(warning));
  d["warnings"] = warnings;
  return findings(d);
}

py::object simulate(const Call& call) {
  workflow::SimulateJob job;
  job.cache = io::cache_folder();
  job.keep_image = true;
  call.apply(job);  // numbers first: a wrong one does not wait for a large mesh
  job.command_line = "semsurf.simulate(...) in Python";
  auto request = call.told<io::SpecimenRequest>();
  InMemory memory;
  add_specimen(call["specimen"], request, memory.shapes);
  if (call.has("acceptance")) memory.detectors = detectors_of(call["acceptance"]);
  if (const py::object dry = call["dry_run"]; !dry.is_none() && py::bool_(dry))
    return foretold(std::move(job), request, memory, call);
  Simulation simulation(std::move(job));
  call.work(
      [&](const workflow::Reporter& reporter) { simulation.run(request, memory, call, reporter); },
      [&] { return simulation.result(); });
  return simulation.result();
}

}  // namespace

void add_simulate(py::module_& module) {
  Function f{.name = "simulate", .summary = "Simulate the SEM image of a specimen by Monte Carlo."};
  f.details =
      "Any two of `size`, `pixel_size` and `region` define the scan. With one the specimen's\n"
      "extent gives the rest; with none it is 256 pixels across the longer side. Lengths are nm,\n"
      "energies eV, angles degrees; texts may carry another unit: '5keV', '2nm', '40deg'.";
  f.arguments = {specimen_argument,
                 {"dry_run", "bool",
                  "Simulate a part for ten seconds, and tell what the whole would take, as "
                  "Findings."},
                 {"acceptance", "dict[str, Any]",
                  "Detectors of your own, by name: for each a function of arrays, `f(energy_ev, "
                  "direction)`, that returns the probability that electrons are counted, 0 to 1. "
                  "`direction[..., 0]` to `direction[..., 2]` are x, y and z (up). The function is "
                  "called once, for the middles of bins: 90 polar angles, 72 azimuths and, from 0 "
                  "eV to 30 keV, bins of 1 eV or 5 %; `(f, edges_ev)` sets others."}};
  f.takes<io::SpecimenRequest>({}, {"specimen.input"}).takes<workflow::SimulateJob>();
  f.result_type = "Image";
  f.result =
      "Counts per primary: 'SE', 'SE.stderr', 'BSE', 'BSE.stderr' and so on. `record` is as in "
      "files; `found` has the mean yields with standard errors, the method and the warnings.";
  f.example =
      ">>> image = semsurf.simulate('cube.stl', material='Si', substrate='Si', tilt=40)\n"
      ">>> image['SE'].mean(), image.stderr('SE').max()";
  define(module, f, simulate);
}

}  // namespace surf::python
