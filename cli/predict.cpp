// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>

#include "bound_parameters.h"
#include "commands.h"
#include "common_options.h"
#include "job_reporter.h"
#include "model_tables.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/height_field_file.h"
#include "surf/io/sim/scene_file.h"
#include "surf/workflow/predict_job.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* predict_examples =
    R"(HEIGHTS are a scan, an image of heights, or a scene file whose specimen is a height field; the model
must be of the same pixel size, and of the same material and energy where they are known. For other
surfaces than it has learnt from the image is a guess: 'semsurf info MODEL.json' says what it knows.

Examples:
  semsurf predict scan.gwy --model si-1keV-3nm.json --resample -o image.exr -o image.png
  semsurf predict scan.gwy --model si-1keV-3nm.json --resample --png-channel BSE -o bse.png
  semsurf predict fine.gsf --model si-1keV-3nm.json --resample --energy 1keV -o image.vti
  semsurf predict samples/mesa80.toml --model si-1keV-3nm.json --resample -o mesa.exr)";

struct PredictArguments {
  BoundParameters bound;
  std::string heights;
  bool quiet = false;
};

void take_heights(const PredictArguments& o, workflow::PredictJob& job) {
  io::HeightFieldFile scan = io::read_height_field(o.heights, job.reading);
  if (!o.quiet)
    for (const std::string& note : scan.notes) print_note(fmt::format("{}: {}", o.heights, note));
  job.field = std::move(scan.field);
}

void refuse_with_scene(const BoundParameters& bound) {
  for (const char* name : {"scan.height_channel", "scan.height_unit", "scan.height_pitch"})
    if (bound.is_given(name))
      throw UsageError(fmt::format("`{}`", name), "a scene file says this itself",
                       "Change the scene file");
}

workflow::PredictJob predict_job_of(const PredictArguments& o) {
  if (o.heights.empty())
    throw UsageError("HEIGHTS", "no surface is given", "Name a scan or an image of heights");
  workflow::PredictJob asked, job;  // numbers are looked at before files are read
  o.bound.apply(asked);
  if (asked.model.empty())
    throw UsageError("`prediction.model`", "no model is given",
                     "Add `prediction.model=MODEL.json`; 'semsurf train' makes one");
  if (asked.outputs.empty())
    throw UsageError("`output`", "no output file is given", "Add `output=image.exr`");
  job.input = o.heights;
  job.reading = asked.reading;
  if (io::is_scene_file(o.heights)) {
    refuse_with_scene(o.bound);
    workflow::take_scene(o.heights, job);
  } else {
    take_heights(o, job);
  }
  o.bound.apply(job);  // goes before what a scene file says
  return job;
}

std::string format_values(const Channel& channel) {
  const auto& values = channel.values.data();
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double mean =
      std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  return fmt::format("{:.4g} to {:.4g}, mean {:.4g} per primary", *low, *high, mean);
}

int predict(const PredictArguments& o) {
  const workflow::PredictJob job = predict_job_of(o);
  workflow::PredictSummary s;
  {
    const JobReporter reporter(o.quiet);
    s = workflow::run(job, reporter);
  }
  if (o.quiet) return 0;
  const auto line = [](const std::string& label, const std::string& text) {
    print("{:<10} {}\n", label, text);
  };
  line("model", format_model(s.model));
  line("for", format_scope(s.model.scope));
  line("image", fmt::format("{} x {} pixels of {}, in {:.3g} s", s.image.width(), s.image.height(),
                            format_length(s.image.pitch_x_nm), s.seconds));
  line("surface", format_range(s.range));
  for (const Channel& channel : s.image.channels) line(channel.name, format_values(channel));
  print_written(job.outputs);
  return 0;
}

}  // namespace

void add_predict(CLI::App& app, Action& action) {
  const auto o = std::make_shared<PredictArguments>();
  CLI::App* sub =
      app.add_subcommand("predict", "An SEM image of heights by a model, in place of a simulation");
  with_role(
      sub->add_option("HEIGHTS", o->heights, "A scan, an image of heights, or a scene file (TOML)")
          ->type_name("FILE"),
      FileRole::read);
  const char *options = "Options",
             *wanted = "What the image is to be of; a model for anything else is refused";
  o->bound.headings = {{"prediction", options}, {"scan", "Heights"},  {"specimen", wanted},
                       {"beam", wanted},        {"output", "Output"}, {"job", "Output"}};
  o->bound.looks["scan.height_pitch"] = {.former = {"--pitch"}};
  o->bound.looks["scan.height_unit"] = {.former = {"--z-unit"}};
  o->bound.looks["output"] = {.name = "-o,--output"};
  o->bound.looks["output.png_channel"] = {.former = {"--channel"}};
  o->bound.add<workflow::PredictJob>(*sub, "");
  add_quiet_flag(*sub, o->quiet)->group("Output");
  sub->footer(predict_examples);
  sub->callback([o, &action] { action = [o] { return predict(*o); }; });
}

}  // namespace surf::cli
