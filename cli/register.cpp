// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "chain_options.h"
#include "commands.h"
#include "common_options.h"
#include "job_reporter.h"
#include "surf/core/error.h"
#include "surf/io/plot.h"
#include "exit_codes.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* examples =
    R"(Predicts the SEM image of the scan, its tip taken off, and finds the affine map that lays the SEM image on it.
Nothing needs to be known beforehand; landmarks help where the images are alike in several places.
Exit code 4: the registration is not to be trusted, and the verdict says why:
  ambiguous    other places fit as well: they are listed. Give --landmarks
  unconverged  no optimum was settled on. Give --landmarks, or an image with more on it
  unrelated    the images agree nowhere more than chance allows: check files, pixel sizes, material, energy

Examples:
  semsurf register scan.gwy sem.tif --material Si --energy 1keV -o transform.json --picture check.png
  semsurf register scan.gwy sem.tif --model si-1keV-10nm.json --landmarks places.csv -o transform.json
  semsurf register scan.gwy sem.png --sem-pixel-size 10nm --model si.json --objective mutual-information)";

struct Options {
  ChainOptions chain;
  std::optional<std::string> output, picture;
};

int work(const Options& o) {
  if (o.chain.afm.empty()) throw UsageError("AFM", "no scan is given", "Name a scan, then an SEM image");
  if (o.chain.sem.empty()) throw UsageError("SEM", "no SEM image is given", "Name it after the scan");
  workflow::RegisterJob job;
  job.model = model_request(o.chain);
  job.threads = job.model.threads;
  if (o.output) job.transform = *o.output;
  if (o.picture) job.picture = *o.picture;
  if (o.picture) io::check_plot_target(*o.picture);
  job.afm = read_afm(o.chain);
  job.sem = read_sem(o.chain);
  job.pose = pose_options(o.chain, job.afm.scan, job.sem.image);
  workflow::RegisterSummary s;
  {
    const JobReporter reporter(o.chain.quiet);
    s = workflow::run(job, reporter);
  }
  print_pose(s.pose, job.sem.image.pitch_x_nm);
  if (!o.chain.quiet)
    for (const auto& file : {job.transform, job.picture})
      if (!file.empty()) print("{:<10} {}\n", "written", file.string());
  return s.pose.verified() ? 0 : exit_untrustworthy;
}

}  // namespace

void add_register(CLI::App& app, Action& action) {
  const auto o = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("register", "Lay an SEM image on an AFM scan of the same place");
  sub->add_option("AFM", o->chain.afm, "The scan, of any format")->type_name("FILE");
  sub->add_option("SEM", o->chain.sem, "The SEM image")->type_name("FILE");
  add_chain_inputs(*sub, o->chain);
  add_preparation_options(*sub, o->chain);
  add_model_request(*sub, o->chain);
  add_pose_options(*sub, o->chain);
  const char* output = "Output";
  sub->add_option("-o,--output", o->output, "The map, which 'reconstruct --transform' takes")->type_name("FILE.json")->group(output);
  sub->add_option("--picture", o->picture, "Both images and squares of them in turn: .png .svg")->type_name("FILE")->group(output);
  sub->add_option("--seed", o->chain.seed, "Of the noise that tips are judged by (1)")->type_name("N")->group(output);
  add_threads_option(*sub, o->chain.threads)->group(output);
  add_quiet_flag(*sub, o->chain.quiet)->group(output);
  sub->footer(examples);
  sub->callback([o, &action] { action = [o] { return work(*o); }; });
}

}  // namespace surf::cli
