// SPDX-License-Identifier: GPL-3.0-or-later
// Images of surfaces that are known.
#include <fmt/format.h>

#include "sem_inputs.h"
#include "surf/core/error.h"
#include "surf/io/cache.h"
#include "surf/workflow/sample_job.h"

namespace surf::python {
namespace {

py::object listed() {
  py::dict all;
  for (const workflow::SampleScene& scene : workflow::sample_scenes())
    all[py::str(scene.name)] = scene.what;
  return findings(all);
}

py::object sample(const Call& call) {
  workflow::SampleJob job;
  job.cache = io::cache_folder("");
  call.apply(job);
  if (job.name.empty()) return listed();
  if (job.folder.empty()) throw UsageError("`output`", "no folder is given", "Add `output=sample`");
  workflow::SampleSummary s;
  call.work([&](const workflow::Reporter& reporter) {
    s = workflow::run(job, reporter);
    if (!s.complete) throw Interrupted();
  });
  py::dict d;
  d["afm"] = (job.folder / "afm.gsf").string();
  d["sem"] = (job.folder / "sem.tif").string();
  d["truth"] = (job.folder / "truth.gsf").string();
  d["transform"] = matrix_of(s.sem_to_afm);
  d["seconds"] = s.seconds;
  d["written"] = list_of(s.written);
  return findings(d);
}

}  // namespace

void add_samples(py::module_& module) {
  Function f{.name = "sample",
             .summary = "A scan and an SEM image of a known surface, to try a reconstruction on."};
  f.details =
      "Without a name it tells which surfaces there are. Ctrl-C keeps what is done, and the same\n"
      "call goes on from there.";
  f.result_type = "Findings";
  f.result =
      "The files `afm`, `sem` and `truth`, all that were `written`, and the map `transform` of the "
      "SEM image on the scan.";
  f.example = ">>> semsurf.sample(name='pads', output='pads')";
  define(module, f.takes<workflow::SampleJob>(), sample);
}

}  // namespace surf::python
