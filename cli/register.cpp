// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "chain_options.h"
#include "commands.h"
#include "common_options.h"
#include "exit_codes.h"
#include "job_reporter.h"
#include "surf/core/error.h"
#include "surf/io/plot.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* register_examples =
    R"(Predicts the SEM image of the scan, its tip taken off, and finds the affine map that lays the SEM image on it.
Nothing needs to be known beforehand; landmarks help where the images are alike in several places.
Exit code 4: the registration is not to be trusted, and the verdict says why:
  ambiguous    other places fit as well: they are listed. Give --landmarks
  unconverged  no optimum was settled on. Give --landmarks, or an image with more on it
  unrelated    the images agree nowhere more than chance allows: check files, pixel sizes, material, energy

Examples:
  semsurf register --afm scan.gwy --sem sem.tif --material Si --energy 1keV -o transform.json --picture check.png
  semsurf register --afm scan.gwy --sem sem.tif --model si-1keV-10nm.json --landmarks places.csv -o transform.json
  semsurf register --afm scan.gwy --sem sem.png --pixel-size 10nm --model si.json --objective mutual-information)";

int register_work(const ChainOptions& o) {
  ChainFiles files;
  workflow::RegisterJob job;
  o.bound.apply(files), o.bound.apply(job);
  if (files.afm.empty())
    throw UsageError("`reconstruction.afm`", "no scan is given",
                     "Name one, as `reconstruction.afm=scan.gwy`");
  if (files.sem.empty())
    throw UsageError("`reconstruction.sem`", "no SEM image is given",
                     "Name one, as `reconstruction.sem=image.tif`");
  if (files.sem.size() > 1)
    throw UsageError("`reconstruction.sem`", "several SEM images are given",
                     "Register the one that looks straight down: 'semsurf reconstruct' finds the "
                     "places of further ones");
  if (!job.picture.empty()) io::check_plot_target(job.picture);
  take_model(o, files, job.threads, job.model);
  take_afm(o, files, job.afm);
  take_sem(o, files.sem.front(), job.sem);
  take_pose(o, files, job.afm.scan, job.sem.image, job.pose);
  workflow::RegisterSummary s;
  {
    const JobReporter reporter(o.quiet);
    s = workflow::run(job, reporter);
  }
  print_pose(s.pose, job.sem.image.pitch_x_nm);
  if (!o.quiet)
    for (const auto& file : {job.transform, job.picture})
      if (!file.empty()) print("{:<10} {}\n", "written", file.string());
  return s.pose.verified() ? 0 : exit_untrustworthy;
}

}  // namespace

void add_register(CLI::App& app, Action& action) {
  const auto o = std::make_shared<ChainOptions>();
  CLI::App* sub =
      app.add_subcommand("register", "Lay an SEM image on an AFM scan of the same place");
  add_chain_options(*sub, *o);
  o->bound.looks["reconstruction.afm"] = {.former = {"AFM"}};
  o->bound.looks["reconstruction.sem"] = {.former = {"SEM"}};
  for (const char* name : {"registration.transform", "registration.accept_registration"})
    o->bound.looks[name] = {.hidden = true};
  o->bound.add<ChainFiles>(*sub, "");
  o->bound.add<workflow::RegisterJob>(*sub, "");
  add_quiet_flag(*sub, o->quiet)->group("Output");
  sub->footer(register_examples);
  sub->callback([o, &action] { action = [o] { return register_work(*o); }; });
}

}  // namespace surf::cli
