// SPDX-License-Identifier: GPL-3.0-or-later
#include "train_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common_options.h"
#include "surf/core/error.h"
#include "surf/core/some_parameters.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"
#include "surf/io/model/model_file.h"
#include "surf/workflow/picture_input.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* train_options_examples =
    R"(Without HEIGHTS the model learns on surfaces of semsurf's own: blocks, pits, rough ones, bumps, lines,
pyramids. Without images they are simulated, into NAME.training beside NAME.json: stop when you like,
the same command goes on from there, and images that are there already are used again. Under mpirun each
process simulates whole images, and one learns from them.
Kinds that need no images are only judged on them, where HEIGHTS or --surfaces ask for some.
The table at the end says how far the model is off on each surface, the images' noise subtracted; with
--hold-out N on the last N, which it has not seen.

Examples:
  semsurf train --material Si --energy 1keV --pixel-size 3nm -o si-1keV-3nm.json
  semsurf train --pixel-size 3nm --surfaces 16 --hold-out 4 -o si.json
  semsurf train scan.gwy large.gsf --material Au --energy 5keV --pixel-size 20nm -o gold.json
  semsurf train a.gsf b.gsf --images a.exr --images b.exr -o si.json
  semsurf train known.gsf --signal sem.tif --material Si --energy 1keV -o our-sem.json
  semsurf train --pixel-size 3nm --kind filter-bank -o bank.json
  mpirun -n 4 semsurf train --pixel-size 3nm --threads 4 -o si.json
  semsurf train --pixel-size 3nm --kind slope-table --surfaces 12 -o slopes.json)";

void tell(const std::vector<std::string>& notes, bool quiet) {
  if (quiet) return;
  for (const std::string& note : notes) print_note(note);
}

workflow::TrainingInput read_input(const std::string& file, const io::HeightReadOptions& reading,
                                   bool quiet) {
  io::HeightFieldFile scan = io::read_height_field(file, reading);
  for (std::string& note : scan.notes) note = fmt::format("{}: {}", file, note);
  tell(scan.notes, quiet);
  return {file, std::move(scan.field), io::sha256_of_file(file), {}};
}

void add_images(const TrainFiles& files, workflow::TrainJob& job) {
  if (!files.images.empty() && !files.signals.empty())
    throw UsageError("`training.signal`", "`training.images` are given too",
                     "Leave one of them out");
  const auto& images = files.signals.empty() ? files.images : files.signals;
  if (images.empty()) return;
  if (images.size() != files.heights.size())
    throw UsageError(
        files.signals.empty() ? "`training.images`" : "`training.signal`",
        fmt::format("{} images are given for {} HEIGHTS", images.size(), files.heights.size()),
        "Give one for each, in the same order");
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (files.signals.empty()) {
      job.inputs[i].image = images[i];
      continue;
    }
    const workflow::FileChannel input = workflow::parse_file_channel(images[i]);
    const std::string channel =
        input.channel.empty() ? io::read_image(input.file).channels.front().name : input.channel;
    if (i > 0 && channel != job.signal)
      throw UsageError("`training.signal`",
                       fmt::format("channel '{}' here and '{}' before", channel, job.signal),
                       "Give the same channel of each image, as FILE:CHANNEL");
    job.signal = channel;
    job.inputs[i].image = input.file;
  }
}

/// What is about semsurf's own surfaces alone, and what only is about surfaces or images that are
/// given.
void refuse_contradictions(const BoundParameters& bound, const TrainFiles& files) {
  if (!files.heights.empty()) {
    for (const char* name : {"training.surfaces", "training.surface_size"})
      if (bound.is_given(name))
        throw UsageError(fmt::format("`{}`", name),
                         "it is about semsurf's own surfaces, and HEIGHTS are given",
                         "Leave it out");
    return;
  }
  for (const char* name : {"training.images", "training.signal", "scan.height_channel",
                           "scan.height_unit", "scan.height_pitch"})
    if (bound.is_given(name))
      throw UsageError(fmt::format("`{}`", name), "no HEIGHTS are given",
                       "Name the surfaces, or leave it out");
}

/// What is about images that a kind without any would leave unused.
void refuse_without_images(const BoundParameters& bound, const TrainFiles& files,
                           const workflow::TrainJob& job) {
  const auto kinds = workflow::learnable_kinds();
  const auto kind = std::ranges::find(kinds, job.learn.kind, &workflow::LearnableKind::name);
  if (kind == kinds.end() || kind->needs_images || job.surfaces || !files.heights.empty()) return;
  for (const char* name :
       {"training.surface_size", "simulation.electrons", "simulation.accuracy", "training.edge"})
    if (bound.is_given(name))
      throw UsageError(fmt::format("`{}`", name),
                       fmt::format("a model '{}' needs no images, so there are none", kind->name),
                       "Leave it out, or add `training.surfaces=N` to judge the model on");
}

void add_material(const TrainFiles& files, bool quiet, workflow::TrainJob& job) {
  io::MaterialChoice material = files.material;
  std::vector<std::string> notes;
  if (material.name.empty()) material.name = "Si";
  job.material = io::find_material(material, notes);
  job.material_files.assign(material.files.begin(), material.files.end());
  if (files.material.name.empty()) notes.push_back("no --material is given: Si is assumed");
  tell(notes, quiet);
}

void add_inputs(const TrainFiles& files, bool quiet, workflow::TrainJob& job) {
  for (const std::string& file : files.heights)
    job.inputs.push_back(read_input(file, job.reading, quiet));
  if (job.pixel_nm > 0) return;
  const HeightField& first = job.inputs.front().field;
  if (first.pitch_x_nm != first.pitch_y_nm)
    throw UsageError("`training.pixel_size`",
                     fmt::format("the samples of {} are not square", files.heights.front()),
                     "Say how large the model's pixels are, as 3nm");
  job.pixel_nm = first.pitch_x_nm;
  tell({fmt::format("no --pixel-size is given: {}, as {}", format_length(job.pixel_nm),
                    files.heights.front())},
       quiet);
}

std::string kinds_in_words() {
  std::string text = "Kinds of models (--kind):\n";
  for (const workflow::LearnableKind& kind : workflow::learnable_kinds())
    text += fmt::format("  {:<22}  {}\n", kind.name, kind.what);
  return text + "\n";
}

}  // namespace

void describe(ParameterVisitor& visit, TrainFiles& files) {
  visit(files.heights, {.name = "training.heights",
                        .help = "Surfaces to learn on: scans and images of heights",
                        .otherwise = "semsurf's own",
                        .form = "FILE",
                        .file = FileRole::read});
  visit(files.images, {.name = "training.images",
                       .help = "Image with channels SE and BSE, one for each of HEIGHTS",
                       .form = "FILE",
                       .file = FileRole::read});
  visit(files.signals, {.name = "training.signal",
                        .help = "Image of a microscope, FILE or FILE:CHANNEL, pixel on sample: the "
                                "model then has its one signal",
                        .form = "FILE",
                        .file = FileRole::read});
  describe_some(visit, files.material,
                {{"specimen.material", "Material of the surfaces", "Si"}, {"specimen.materials"}});
}

workflow::TrainJob make_train_job(const TrainOptions& o) {
  TrainFiles files;
  workflow::TrainJob job;
  o.bound.apply(files), o.bound.apply(job);
  if (job.output.empty())
    throw UsageError("`output`", "no output file is given", "Add -o model.json");
  io::check_model_target(job.output);
  check_parameters(job);
  refuse_contradictions(o.bound, files);
  refuse_without_images(o.bound, files, job);
  if (job.pixel_nm == 0 && files.heights.empty())
    throw UsageError("`training.pixel_size`", "it is missing",
                     "Say how large the pixels of your images are, as 3nm");
  add_material(files, o.quiet, job);
  if (!files.heights.empty()) add_inputs(files, o.quiet, job);
  add_images(files, job);
  return job;
}

void add_train_options(CLI::App& app, TrainOptions& o) {
  OptionLooks& looks = o.bound.looks;
  looks["training.heights"] = {.name = "HEIGHTS", .positional = true};
  looks["output"] = {.name = "-o,--output"};
  looks["simulation.detectors"] = {.name = "--detector"};
  looks["training.kind"] = {.former = {"--model"}};
  looks["training.least_eigenvalue"] = {.former = {"--cut-off"}};
  looks["training.model_error"] = {.former = {"--tolerance"}};
  looks["scan.height_unit"] = {.former = {"--z-unit"}};
  looks["scan.height_pitch"] = {.former = {"--pitch"}};
  const char *surfaces = "Surfaces", *images = "Images of HEIGHTS",
             *conditions = "What the model is for", *model = "Model";
  const char *simulation = "Simulation of missing images", *options = "Options";
  o.bound.headings = {{"training", model},
                      {"training.heights", surfaces},
                      {"training.images", images},
                      {"training.signal", images},
                      {"training.pixel_size", conditions},
                      {"specimen", conditions},
                      {"beam", conditions},
                      {"scan", surfaces},
                      {"simulation", simulation},
                      {"job", simulation},
                      {"job.threads", options},
                      {"output", options}};
  for (const char* name : {"surfaces", "surface_size", "hold_out", "fine", "edge"})
    o.bound.headings[fmt::format("training.{}", name)] = surfaces;
  o.bound.add<TrainFiles>(app, "");
  o.bound.add<workflow::TrainJob>(app, "");
  add_quiet_flag(app, o.quiet)->group(options);
  app.footer(kinds_in_words() + train_options_examples);
}

}  // namespace surf::cli
