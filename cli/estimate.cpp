// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "bound_parameters.h"
#include "commands.h"
#include "common_options.h"
#include "job_reporter.h"
#include "simulate_summary.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/workflow/estimate_job.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* estimate_examples =
    R"(Neighbours know more: where a pixel's electrons are few, those around it tell its yield as well, as
far as shape and a fast model say that it is alike. IMAGE has counts, as
'semsurf simulate --channels counts,electrons,z_nm,normal,material' writes them. NAME becomes the
estimate, NAME.stderr its root mean square error, bias included, and NAME.radius how far in pixels
a pixel shares its error with its neighbours. 'semsurf simulate --estimate guided' does it at once.

Examples:
  semsurf simulate samples/rough.toml --electrons 32 --channels counts,electrons,z_nm,normal,material -o few.exr
  semsurf estimate few.exr -o guided.exr -o guided.png
  semsurf estimate few.exr --model samples/si-1keV-3nm.json -o guided.tif)";

struct EstimateArguments {
  BoundParameters bound;
  std::string image;
  bool quiet = false;
};

int estimate(const EstimateArguments& o) {
  workflow::EstimateJob job;
  o.bound.apply(job);
  if (o.image.empty()) throw UsageError("IMAGE", "no image is given", "Name one that has counts");
  if (job.outputs.empty())
    throw UsageError("`output`", "no output file is given", "Add `output=guided.exr`");
  job.input = o.image;
  workflow::EstimateSummary s;
  {
    const JobReporter reporter(o.quiet);
    s = workflow::run(job, reporter);
  }
  if (o.quiet) return 0;
  const auto line = [](const std::string& label, const std::string& text) {
    print("{:<10} {}\n", label, text);
  };
  line("image", fmt::format("{} x {} pixels of {}", s.image.width(), s.image.height(),
                            format_length(s.image.pitch_x_nm)));
  std::string by;
  for (const std::string& guide : s.guides) by += (by.empty() ? "" : ", ") + guide;
  line("guided by", by.empty() ? "neighbours alone: the image shows no surface" : by);
  for (std::size_t d = 0; d < s.gains.size(); ++d) line(s.detectors[d], format_gain(s.gains[d]));
  print_written(job.outputs);
  return 0;
}

}  // namespace

void add_estimate(CLI::App& app, Action& action) {
  const auto o = std::make_shared<EstimateArguments>();
  CLI::App* sub = app.add_subcommand(
      "estimate", "A simulated image of few electrons, estimated with the help of neighbours");
  with_role(
      sub->add_option("IMAGE", o->image, "An image with counts (EXR, TIFF)")->type_name("FILE"),
      FileRole::read);
  o->bound.headings = {{"estimate", "Guides"}, {"output", "Output"}, {"job", "Output"}};
  o->bound.looks["output"] = {.name = "-o,--output"};
  o->bound.add<workflow::EstimateJob>(*sub, "");
  add_quiet_flag(*sub, o->quiet)->group("Output");
  sub->footer(estimate_examples);
  sub->callback([o, &action] { action = [o] { return estimate(*o); }; });
}

}  // namespace surf::cli
