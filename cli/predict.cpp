// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <tuple>

#include "commands.h"
#include "common_options.h"
#include "job_reporter.h"
#include "model_tables.h"
#include "options.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/height_field_file.h"
#include "surf/io/sim/scene_file.h"
#include "surf/workflow/predict_job.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* examples =
    R"(HEIGHTS are a scan, an image of heights, or a scene file whose specimen is a height field; the model
must be of the same pixel size, and of the same material and energy where they are known. For other
surfaces than it has learnt from the image is a guess: 'semsurf info MODEL.json' says what it knows.

Examples:
  semsurf predict scan.gwy --model si-1keV-3nm.json -o image.exr -o image.png
  semsurf predict scan.gwy --model si-1keV-3nm.json --channel BSE -o bse.png
  semsurf predict fine.gsf --model si-1keV-3nm.json --resample --energy 1keV -o image.vti
  semsurf predict samples/mesa80.toml --model si-1keV-3nm.json --resample -o mesa.exr)";

struct Options {
  std::string heights;
  std::optional<std::string> model, height_channel, z_unit, pitch, edge;
  std::optional<std::string> material, energy, spot, threads;
  std::string channel;
  std::vector<std::string> outputs;
  bool resample = false, quiet = false;
};

/// What a scene file says of the specimen and the beam.
void take_scene(const std::string& file, workflow::PredictJob& job) {
  const io::SceneFile scene = io::read_scene(file);
  const mc::Specimen& specimen = scene.specimen;
  if (!specimen.height_field || !specimen.bodies.empty())
    throw UsageError(file, "its specimen is not a height field alone", "Only 'semsurf simulate' can image it");
  if (scene.beam.tilt_deg != 0)
    throw UsageError(file, "its beam is tilted", "Models are for a beam from straight above: use 'semsurf simulate'");
  job.field = specimen.height_field->field;
  job.edge = specimen.height_field->edge;
  job.wanted.material = specimen.materials.at(static_cast<std::size_t>(specimen.height_field->material)).name;
  job.wanted.energy_ev = scene.beam.energy_ev;
  job.wanted.spot_nm = scene.beam.spot_nm;
}

void take_heights(const Options& o, workflow::PredictJob& job) {
  io::HeightReadOptions read;
  read.channel = o.height_channel.value_or("");
  if (o.z_unit) read.z_unit_nm = parse_unit_nm(*o.z_unit, "--z-unit");
  if (o.pitch) std::tie(read.pitch_x_nm, read.pitch_y_nm) = parse_pixel_size(*o.pitch, "--pitch");
  io::HeightFieldFile scan = io::read_height_field(o.heights, read);
  if (!o.quiet)
    for (const std::string& note : scan.notes) print_note(fmt::format("{}: {}", o.heights, note));
  job.field = std::move(scan.field);
}

void refuse_with_scene(const Options& o) {
  for (const auto& [given, option] : {std::pair{&o.height_channel, "--height-channel"}, std::pair{&o.z_unit, "--z-unit"},
                                      std::pair{&o.pitch, "--pitch"}})
    if (given->has_value()) throw UsageError(option, "a scene file says this itself", "Change the scene file");
}

workflow::PredictJob make_job(const Options& o) {
  if (o.heights.empty()) throw UsageError("HEIGHTS", "no surface is given", "Name a scan or an image of heights");
  if (!o.model) throw UsageError("--model", "no model is given", "Add --model MODEL.json; 'semsurf train' makes one");
  if (o.outputs.empty()) throw UsageError("--output", "no output file is given", "Add -o image.exr");
  workflow::PredictJob job;
  job.threads = parse_threads(o.threads);
  job.model = *o.model;
  job.input = o.heights;
  job.resample = o.resample;
  job.png_channel = o.channel;
  job.outputs.assign(o.outputs.begin(), o.outputs.end());
  ModelScope given;
  if (o.energy) given.energy_ev = parse_energy_ev(*o.energy, "--energy");
  if (o.spot) given.spot_nm = parse_length_nm(*o.spot, "--spot");
  std::optional<Edge> edge;
  if (o.edge) edge = parse_edge(*o.edge, "--edge");
  if (io::is_scene_file(o.heights)) {
    refuse_with_scene(o);
    take_scene(o.heights, job);
  } else {
    take_heights(o, job);
  }
  if (o.material) job.wanted.material = *o.material;
  if (o.energy) job.wanted.energy_ev = given.energy_ev;
  if (o.spot) job.wanted.spot_nm = given.spot_nm;
  if (edge) job.edge = *edge;
  return job;
}

std::string format_values(const Channel& channel) {
  const auto& values = channel.values.data();
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  return fmt::format("{:.4g} to {:.4g}, mean {:.4g} per primary", *low, *high, mean);
}

int predict(const Options& o) {
  const workflow::PredictJob job = make_job(o);
  workflow::PredictSummary s;
  {
    const JobReporter reporter(o.quiet);
    s = workflow::run(job, reporter);
  }
  if (o.quiet) return 0;
  const auto line = [](const std::string& label, const std::string& text) { print("{:<10} {}\n", label, text); };
  line("model", format_model(s.model));
  line("for", format_scope(s.model.scope));
  line("image", fmt::format("{} x {} pixels of {}, in {:.3g} s", s.image.width(), s.image.height(),
                            format_length(s.image.pitch_x_nm), s.seconds));
  line("surface", format_range(s.range));
  for (const Channel& channel : s.image.channels) line(channel.name, format_values(channel));
  std::string label = "written";
  for (const auto& output : job.outputs) {
    line(label, output.string());
    label.clear();
  }
  return 0;
}

}  // namespace

void add_predict(CLI::App& app, Action& action) {
  const auto o = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("predict", "An SEM image of heights by a model, in place of a simulation");
  sub->add_option("HEIGHTS", o->heights, "A scan, an image of heights, or a scene file (TOML)")->type_name("FILE");
  sub->add_option("--model", o->model, "The model, as 'semsurf train' writes it")->type_name("FILE.json");
  sub->add_option("--edge", o->edge, "How the heights go on outside (mirror)")->type_name("mirror|flat|periodic");
  sub->add_flag("--resample", o->resample, "Resample heights of another pitch to the model's pixels");
  const char* heights = "Heights";
  sub->add_option("--height-channel", o->height_channel, "Channel of HEIGHTS, by name or number (the first of heights)")
      ->type_name("NAME")->group(heights);
  sub->add_option("--pitch", o->pitch, "Sample distance of files that do not say (1nm)")->type_name("LENGTH")->group(heights);
  sub->add_option("--z-unit", o->z_unit, "Length of one unit of height, of files that do not say (nm)")
      ->type_name("LENGTH")->group(heights);
  const char* wanted = "What the image is to be of; a model for anything else is refused";
  sub->add_option("--material", o->material, "What the surface is made of")->type_name("MATERIAL")->group(wanted);
  sub->add_option("--energy", o->energy, "Of the beam")->type_name("ENERGY")->group(wanted);
  sub->add_option("--spot", o->spot, "Standard deviation of the Gaussian spot")->type_name("LENGTH")->group(wanted);
  const char* output = "Output";
  sub->add_option("-o,--output", o->outputs, "Image file (EXR, TIFF, PNG, VTI); may be repeated")
      ->type_name("FILE")->option_text("FILE")->allow_extra_args(false)->group(output);
  sub->add_option("--channel", o->channel, "What a PNG shows (the model's first channel)")->type_name("NAME")->group(output);
  add_threads_option(*sub, o->threads)->group(output);
  add_quiet_flag(*sub, o->quiet)->group(output);
  sub->footer(examples);
  sub->callback([o, &action] { action = [o] { return predict(*o); }; });
}

}  // namespace surf::cli
