// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruct_options.h"

#include <fmt/format.h>

#include "common_options.h"
#include "surf/core/error.h"
#include "surf/io/height_field_file.h"
#include "surf/io/model/calibration_file.h"

namespace surf::cli {
namespace {

constexpr const char* reconstruct_options_examples =
    R"(Does all of it: levels the scan, finds its noise and its tip, takes the tip off, trains a fast model of SEM images
or takes one that was kept, registers, calibrates, and finds the surface that makes both images most likely, with
its uncertainty. Each step can be overridden; FOLDER/report.json says what was used and how to repeat it, and
FOLDER/panel.png shows everything: begin there. docs/how-to/reconstruction.md explains it.
Ctrl-C or a crash loses one scale at most: the same command goes on.
Exit code 4: there is a result but not to be trusted (the report's "reasons"), or the images seem to show different places.

Examples:
  semsurf reconstruct --afm scan.gwy --sem image.tif --material Si --energy 1keV -o result
  semsurf reconstruct --afm scan.gwy --sem image.png --pixel-size 10nm --model si.json --landmarks places.csv -o result
  semsurf reconstruct --afm scan.gwy --sem image.tif --model si.json --transform transform.json --tip tip.gsf -o result
  semsurf reconstruct --afm scan.gwy --sem up.tif --sem tilted.tif --tilt 0deg --tilt 3deg --model si.json -o result
  semsurf reconstruct --afm scan.gwy -o result
  semsurf reconstruct --sem image.tif --model si.json --gains 900,300 --offset 120 -o result)";

struct ReconstructFiles {
  std::string calibration, truth;
};

void describe(ParameterVisitor& visit, ReconstructFiles& files) {
  visit(files.calibration, {.name = "reconstruction.calibration",
                            .help = "Gains and offset as 'semsurf calibrate' writes them",
                            .form = "FILE.json",
                            .file = FileRole::read});
  visit(files.truth, {.name = "reconstruction.truth",
                      .help = "Heights in the SEM's frame, to compare the result with",
                      .form = "FILE",
                      .file = FileRole::read});
}

/// Before any file is read.
void refuse_contradictions(const BoundParameters& bound, const ReconstructFiles& files,
                           const workflow::ReconstructJob& job) {
  if (!files.calibration.empty() && job.calibration)
    throw UsageError("`reconstruction.calibration`", "gains or an offset are given, too",
                     "Leave one of them out");
  if (job.refine_tip == true && job.options.method != ReconstructionMethod::gauss_newton)
    throw UsageError("`reconstruction.refine_tip`", "only Gauss-Newton fits the tip",
                     "Leave out `reconstruction.optimiser`, or `reconstruction.refine_tip`");
  if (job.afm && job.sem) return;
  for (const char* name : {"registration.transform", "registration.landmarks"})
    if (bound.is_given(name))
      throw UsageError(fmt::format("`{}`", name), "there is one image only",
                       "Leave it out, or give both `reconstruction.afm` and `reconstruction.sem`");
}

/// With a part for each image, so that all can be described.
workflow::ReconstructJob whole_job() {
  workflow::ReconstructJob job;
  job.afm.emplace();
  job.sem.emplace();
  return job;
}

}  // namespace

workflow::ReconstructJob make_reconstruct_job(const ChainOptions& o) {
  ChainFiles inputs;
  ReconstructFiles files;
  workflow::ReconstructJob job = whole_job();
  o.bound.apply(inputs), o.bound.apply(files), o.bound.apply(job);
  if (job.folder.empty())
    throw UsageError("`output`", "no folder for the result is given", "Add -o result");
  if (inputs.afm.empty() && inputs.sem.empty())
    throw UsageError("reconstruct", "neither a scan nor an SEM image is given",
                     "Add --afm scan.gwy, --sem image.tif, or both");
  if (inputs.afm.empty()) job.afm.reset();
  if (inputs.sem.empty()) job.sem.reset();
  refuse_contradictions(o.bound, files, job);
  if (!files.calibration.empty()) {
    const Calibration c = io::read_calibration(files.calibration).calibration;
    job.calibration = {c.gains, c.offset};
  }
  if (job.sem) take_model(o, inputs, job.options.threads, job.model);
  job.material_files = inputs.material.files;
  if (job.afm) take_afm(o, inputs, *job.afm);
  if (job.sem) {
    for (std::size_t k = 1; k < inputs.sem.size(); ++k) {
      job.views.emplace_back();
      job.views.back().reading = job.sem->reading;
      take_sem(o, inputs.sem[k], job.views.back());
    }
    take_sem(o, inputs.sem.front(), *job.sem);
  }
  if (job.afm && job.sem) take_pose(o, inputs, job.afm->scan, job.sem->image, job.pose);
  if (!files.truth.empty()) {
    job.truth = io::read_height_field(files.truth).field;
    job.truth_file = files.truth;
  }
  return job;
}

void add_reconstruct_options(CLI::App& app, ChainOptions& o) {
  add_chain_options(app, o);
  o.bound.add<ChainFiles>(app, "");
  o.bound.add(app, "", whole_job());
  o.bound.add<ReconstructFiles>(app, "");
  add_quiet_flag(app, o.quiet)->group("Output");
  app.footer(reconstruct_options_examples);
}

}  // namespace surf::cli
