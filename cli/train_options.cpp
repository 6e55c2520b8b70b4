// SPDX-License-Identifier: GPL-3.0-or-later
#include "train_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "common_options.h"
#include "options.h"
#include "picture_input.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/cache.h"
#include "surf/io/files.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/model_file.h"
#include "surf/io/sim/materials.h"
#include "surf/workflow/stored_model.h"
#include "terminal.h"
#include "train_model_options.h"

namespace surf::cli {
namespace {

constexpr const char* examples =
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
  semsurf train scan.gwy other.gsf --material Au --energy 5keV --pixel-size 2nm -o gold.json
  semsurf train a.gsf b.gsf --images a.exr --images b.exr --pixel-size 3nm -o si.json
  semsurf train known.gsf --signal sem.tif --material Si --energy 1keV -o our-sem.json
  semsurf train --pixel-size 3nm --model filter-bank -o bank.json
  mpirun -n 4 semsurf train --pixel-size 3nm --threads 4 -o si.json
  semsurf train --pixel-size 3nm --model slope-table --surfaces 12 -o slopes.json)";

std::optional<double> pitch_of(const TrainOptions& o) {
  if (!o.pitch) return std::nullopt;
  const auto [x, y] = parse_pixel_size(*o.pitch, "--pitch");
  if (!(x > 0) || x != y) throw UsageError("--pitch", "it must be one length above zero", "Write --pitch 2nm");
  return x;
}

workflow::TrainingInput read_input(const std::string& file, const TrainOptions& o) {
  io::HeightReadOptions read;
  read.channel = o.height_channel.value_or("");
  if (o.z_unit) read.z_unit_nm = parse_unit_nm(*o.z_unit, "--z-unit");
  read.pitch_x_nm = read.pitch_y_nm = pitch_of(o);
  io::HeightFieldFile scan = io::read_height_field(file, read);
  if (!o.quiet)
    for (const std::string& note : scan.notes) print_note(fmt::format("{}: {}", file, note));
  return {file, std::move(scan.field), io::sha256_of_file(file), {}};
}

void add_images(const TrainOptions& o, workflow::TrainJob& job) {
  if (!o.images.empty() && !o.signals.empty())
    throw UsageError("--signal", "--images are given too", "Leave one of them out");
  const auto& files = o.signals.empty() ? o.images : o.signals;
  const char* const option = o.signals.empty() ? "--images" : "--signal";
  if (files.empty()) return;
  if (files.size() != o.heights.size())
    throw UsageError(option, fmt::format("{} images are given for {} HEIGHTS", files.size(), o.heights.size()),
                     "Give one for each, in the same order");
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (o.signals.empty()) {
      job.inputs[i].image = files[i];
      continue;
    }
    const FileChannel input = parse_file_channel(files[i]);
    const std::string channel =
        input.channel.empty() ? io::read_image(input.file).channels.front().name : input.channel;
    if (i > 0 && channel != job.signal)
      throw UsageError("--signal", fmt::format("channel '{}' here and '{}' before", channel, job.signal),
                       "Give the same channel of each image, as FILE:CHANNEL");
    job.signal = channel;
    job.inputs[i].image = input.file;
  }
}

void add_budget(const TrainOptions& o, workflow::TrainJob& job) {
  if (o.electrons && o.accuracy)
    throw UsageError("--electrons", "with --accuracy there are two ways to say how much is simulated",
                     "Leave out one of the two");
  job.simulation.budget = mc::ElectronsPerPixel{o.electrons ? parse_whole(*o.electrons, "--electrons", 1, std::int64_t{1} << 31)
                                         : workflow::ModelRequest{}.electrons};
  if (o.accuracy) {
    job.simulation.budget = mc::Accuracy{parse_share(*o.accuracy, "--accuracy")};
    job.simulation.method = mc::Method::replay;
  }
  if (o.seed) job.simulation.seed = parse_seed(*o.seed, "--seed");
  job.simulation.threads = parse_threads(o.threads);
}

void add_surfaces(const TrainOptions& o, workflow::TrainJob& job) {
  for (const auto& [given, option] : {std::pair{&o.surfaces, "--surfaces"}, std::pair{&o.surface_size, "--surface-size"}})
    if (given->has_value() && !o.heights.empty())
      throw UsageError(option, "it is about semsurf's own surfaces, and HEIGHTS are given", "Leave it out");
  if (o.surfaces) job.surfaces = static_cast<int>(parse_whole(*o.surfaces, "--surfaces", 1, 1000));
  if (o.surface_size) job.surface_px = static_cast<int>(parse_whole(*o.surface_size, "--surface-size", 16, 4096));
  if (o.fine) job.fine = static_cast<int>(parse_whole(*o.fine, "--fine", 1, 8));
  if (o.hold_out) job.held_out = static_cast<int>(parse_whole(*o.hold_out, "--hold-out", 0, 1000));
}

void add_conditions(const TrainOptions& o, workflow::TrainJob& job) {
  io::MaterialLibrary materials;
  std::vector<std::string> notes;
  for (const std::string& file : o.materials) materials.read(file, notes);
  job.material = materials.find(o.material.value_or("Si"), "--material");
  if (!o.material) notes.push_back("no --material is given: Si");
  if (o.energy) job.energy_ev = parse_energy_ev(*o.energy, "--energy");
  if (o.spot) job.spot_nm = parse_length_nm(*o.spot, "--spot");
  mc::Beam beam;
  beam.energy_ev = job.energy_ev;
  beam.spot_nm = job.spot_nm;
  mc::validate(beam);
  if (o.physics) mc::parse_physics(*o.physics, job.physics);
  if (o.cutoff) job.physics.cutoff_ev = parse_energy_ev(*o.cutoff, "--cutoff");
  if (o.pixel_size) {
    const auto [x, y] = parse_pixel_size(*o.pixel_size, "--pixel-size");
    if (!(x > 0) || x != y)
      throw UsageError("--pixel-size", "a model's pixels are square and above zero", "Write --pixel-size 3nm");
    job.pixel_nm = x;
  } else if (o.heights.empty()) {
    throw UsageError("--pixel-size", "it is missing", "Say how large the pixels of your images are, as 3nm");
  }
  if (!o.quiet)
    for (const std::string& note : notes) print_note(note);
}

void add_inputs(const TrainOptions& o, workflow::TrainJob& job) {
  if (o.heights.empty()) {
    for (const auto& [given, option] : {std::pair{!o.images.empty(), "--images"}, std::pair{!o.signals.empty(), "--signal"},
                                        std::pair{o.height_channel.has_value(), "--height-channel"},
                                        std::pair{o.z_unit.has_value(), "--z-unit"}, std::pair{o.pitch.has_value(), "--pitch"}})
      if (given) throw UsageError(option, "no HEIGHTS are given", "Name the surfaces, or leave it out");
    return;
  }
  for (const std::string& file : o.heights) job.inputs.push_back(read_input(file, o));
  if (job.pixel_nm > 0) return;
  const HeightField& first = job.inputs.front().field;
  if (first.pitch_x_nm != first.pitch_y_nm)
    throw UsageError("--pixel-size", fmt::format("the samples of {} are not square", o.heights.front()),
                     "Say how large the model's pixels are, as 3nm");
  job.pixel_nm = first.pitch_x_nm;
  if (!o.quiet) print_note(fmt::format("no --pixel-size is given: {}, as {}", format_length(job.pixel_nm), o.heights.front()));
}

/// The command without what does not change the model: threads, cache, the output's place, folders.
std::string telling_command(const TrainOptions& o) {
  std::string text = "semsurf train";
  const auto file = [](const std::string& name) { return std::filesystem::path(name).filename().string(); };
  for (const std::string& name : o.heights) text += " " + file(name);
  for (const auto& [files, option] : {std::pair{&o.images, "--images"}, std::pair{&o.signals, "--signal"},
                                      std::pair{&o.materials, "--materials"}})
    for (const std::string& name : *files) text += fmt::format(" {} {}", option, file(name));
  for (const auto& [value, option] :
       {std::pair{&o.material, "--material"}, std::pair{&o.energy, "--energy"}, std::pair{&o.spot, "--spot"},
        std::pair{&o.pixel_size, "--pixel-size"}, std::pair{&o.model, "--model"}, std::pair{&o.scales, "--scales"},
        std::pair{&o.cut_off, "--cut-off"}, std::pair{&o.hidden, "--hidden"},
        std::pair{&o.iterations, "--iterations"}, std::pair{&o.decay, "--decay"},
        std::pair{&o.tolerance, "--tolerance"}, std::pair{&o.table_electrons, "--table-electrons"},
        std::pair{&o.surfaces, "--surfaces"},
        std::pair{&o.surface_size, "--surface-size"}, std::pair{&o.hold_out, "--hold-out"}, std::pair{&o.fine, "--fine"}, std::pair{&o.edge, "--edge"},
        std::pair{&o.height_channel, "--height-channel"}, std::pair{&o.pitch, "--pitch"}, std::pair{&o.z_unit, "--z-unit"},
        std::pair{&o.electrons, "--electrons"}, std::pair{&o.accuracy, "--accuracy"}, std::pair{&o.physics, "--physics"},
        std::pair{&o.cutoff, "--cutoff"}, std::pair{&o.seed, "--seed"}})
    if (value->has_value()) text += fmt::format(" {} {}", option, **value);
  return text + (o.multi_resolution ? " --multi-resolution" : "");
}

}  // namespace

workflow::TrainJob make_train_job(const TrainOptions& o) {
  workflow::TrainJob job;
  if (!o.output) throw UsageError("--output", "no output file is given", "Add -o model.json");
  job.output = *o.output;
  io::check_model_target(job.output);
  add_budget(o, job);
  add_model(o, job);
  add_surfaces(o, job);
  if (o.edge) job.edge = parse_edge(*o.edge, "--edge");
  add_conditions(o, job);
  add_inputs(o, job);
  add_images(o, job);
  job.cache = o.cache ? io::cache_folder(*o.cache) : std::filesystem::path();
  job.command_line = telling_command(o);
  return job;
}

void add_train_options(CLI::App& app, TrainOptions& o) {
  app.add_option("HEIGHTS", o.heights, "Surfaces to learn on: scans and images of heights (semsurf's own)")
      ->type_name("FILE");
  const char* surfaces = "Surfaces";
  app.add_option("--surfaces", o.surfaces, "How many of semsurf's own; there are 20 kinds (60; 0 if no images are needed)")
      ->type_name("N")->group(surfaces);
  app.add_option("--surface-size", o.surface_size, "Pixels across each of them (64)")->type_name("N")->group(surfaces);
  app.add_option("--hold-out", o.hold_out, "Judge the model on the last N surfaces, without learning from them (0)")
      ->type_name("N")->group(surfaces);
  app.add_option("--fine", o.fine, "Simulate with N samples per pixel, smooth between them (so many that they are at most a\n"
                                   "fifth of the electrons' range apart)")
      ->type_name("N")->group(surfaces);
  app.add_option("--edge", o.edge, "How surfaces go on outside (mirror)")
      ->type_name("mirror|flat|periodic")->group(surfaces);
  app.add_option("--height-channel", o.height_channel, "Channel of HEIGHTS, by name or number (the first of heights)")
      ->type_name("NAME")->group(surfaces);
  app.add_option("--pitch", o.pitch, "Sample distance of HEIGHTS that do not say (1nm)")->type_name("LENGTH")->group(surfaces);
  app.add_option("--z-unit", o.z_unit, "Length of one unit of height, of files that do not say (nm)")
      ->type_name("LENGTH")->group(surfaces);
  const char* images = "Images of them";
  app.add_option("--images", o.images, "With channels SE and BSE, one for each of HEIGHTS; may be repeated")
      ->type_name("FILE")->option_text("FILE")->allow_extra_args(false)->group(images);
  app.add_option("--signal", o.signals,
                 "Instead: of a microscope, FILE or FILE:CHANNEL, pixel on sample; the\n"
                 "model then has its one signal")
      ->type_name("FILE")->option_text("FILE")->allow_extra_args(false)->group(images);
  const char* conditions = "What the model is for";
  app.add_option("--material", o.material, "What the surfaces are made of (Si)")->type_name("MATERIAL")->group(conditions);
  add_materials_option(app, o.materials)->group(conditions);
  app.add_option("--energy", o.energy, "Of the beam, 100eV to 30keV (1keV)")->type_name("ENERGY")->group(conditions);
  app.add_option("--spot", o.spot, "Standard deviation of the Gaussian spot (0nm)")->type_name("LENGTH")->group(conditions);
  app.add_option("--pixel-size", o.pixel_size, "Of the images, square (that of the first of HEIGHTS)")
      ->type_name("LENGTH")->group(conditions);
  add_train_model_options(app, o);
  const char* simulation = "Simulation of missing images";
  app.add_option("--electrons", o.electrons, "Primaries per pixel (150)")->type_name("N")->group(simulation);
  app.add_option("--accuracy", o.accuracy, "Instead: as many as bring standard errors down to this, as 3%")
      ->type_name("SHARE")->group(simulation);
  app.add_option("--physics", o.physics,
                 "elastic=mott|browning, loss=joy-luo|none, secondaries=on|off,\n"
                 "barrier=quantum|classical|off; any of them, first ones default")
      ->type_name("KEY=VALUE,...")->group(simulation);
  app.add_option("--cutoff", o.cutoff, "Where tracking stops (at the barrier)")->type_name("ENERGY")->group(simulation);
  app.add_option("--seed", o.seed, "Of surfaces and simulations (1)")->type_name("N")->group(simulation);
  app.add_option("--cache", o.cache, "Where libraries of cascades are kept: every image has its own of 115 MB or so (off)")
      ->type_name("FOLDER|off")->group(simulation);
  app.add_option("-o,--output", o.output, "The model, .json")->type_name("FILE");
  add_threads_option(app, o.threads);
  add_quiet_flag(app, o.quiet);
  app.footer(kinds_in_words() + examples);
}

}  // namespace surf::cli
