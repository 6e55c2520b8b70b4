// SPDX-License-Identifier: GPL-3.0-or-later
#include "chain_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "afm_options.h"
#include "common_options.h"
#include "options.h"
#include "sem_input.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/cache.h"
#include "surf/io/landmarks_file.h"
#include "surf/io/sim/materials.h"
#include "surf/io/tip_file.h"
#include "surf/workflow/tip_job.h"
#include "terminal.h"

namespace surf::cli {
namespace {

using workflow::LevelMethod;

workflow::LevelParameters level_parameters(const ChainOptions& o) {
  workflow::LevelParameters level;
  o.bound.apply(level);
  if (o.no_level && o.bound.is_given("level.method"))
    throw UsageError("--no-level", "with --level-method there are two ways", "Leave out one of the two");
  if (o.no_level) level.method = LevelMethod::none;
  if (o.bound.is_given("level.degree") && level.method != LevelMethod::polynomial)
    throw UsageError("--level-degree", "only a polynomial has one", "Add --level-method polynomial");
  return level;
}

/// "ALPHA,INNOVATION", the innovation in nm^2.
AfmNoise parse_afm_noise(const std::string& text) {
  const auto numbers = parse_numbers(text, "--afm-noise");
  AfmNoise noise;
  if (numbers.size() == 2) noise = {numbers[0], numbers[1]};
  try {
    if (numbers.size() != 2) throw InvalidInput("", "", "");
    validate(noise);
  } catch (const InvalidInput&) {
    throw UsageError(
        "--afm-noise", fmt::format("'{}' is no noise", text),
        "Give alpha, below 1, and the variance of the innovation in nm^2, as 0.8,0.2; 'semsurf noise scan' finds them");
  }
  return noise;
}

/// A file, or a shape with or without "shape:" before it.
Tip read_tip_option(const ChainOptions& o, const HeightField& scan) {
  std::string text = *o.tip;
  const bool named = text.starts_with("shape:");
  if (named) text.erase(0, 6);
  const bool shape = named || std::ranges::any_of(std::initializer_list<const char*>{"parabola:", "cone:", "pyramid:", "ball:"},
                                                  [&](const char* kind) { return text.starts_with(kind); });
  if (!shape) return io::read_tip(text);
  const int shorter = std::min(scan.z_nm.width(), scan.z_nm.height());
  const int usual = std::min(41, shorter / 2 * 2 - 1);
  workflow::TipShapeParameters parameters{workflow::parse_tip_shape(text, "--tip"), usual, scan.pitch_x_nm,
                                          scan.pitch_y_nm};
  if (o.tip_size) parameters.size = static_cast<int>(parse_whole(*o.tip_size, "--tip-size", 1, 4001));
  return workflow::tip_by_shape(parameters, "--tip");
}

void take_preparation(const ChainOptions& o, workflow::AfmInput& afm) {
  workflow::AfmPreparationOptions& p = afm.preparation;
  p.level = level_parameters(o);
  if (o.afm_noise) p.noise = parse_afm_noise(*o.afm_noise);
  if (o.tip_size) p.tip_size = static_cast<int>(parse_whole(*o.tip_size, "--tip-size", 3, 1001));
  if (o.tip) p.tip = read_tip_option(o, afm.scan);
  if (o.seed) p.seed = parse_seed(*o.seed, "--seed");
}

/// Where the samples of a scan lie, for its pixels.
PlacedImage place_of(const HeightField& f) { return {f.z_nm, f.valid, f.pitch_x_nm, f.pitch_y_nm, f.origin_x_nm, f.origin_y_nm}; }

}  // namespace

workflow::AfmInput read_afm(const ChainOptions& o) {
  io::HeightReadOptions reading;
  o.bound.apply(reading);
  workflow::AfmInput afm;
  afm.scan = read_scan(o.afm, reading, o.quiet).field;
  afm.file = o.afm;
  take_preparation(o, afm);
  return afm;
}

workflow::SemInput read_sem(const ChainOptions& o) {
  return {read_sem_input({o.sem, o.sem_channel, o.sem_pixel_size}, o.quiet), o.sem};
}

workflow::ModelRequest model_request(const ChainOptions& o) {
  workflow::ModelRequest request;
  io::MaterialLibrary materials;
  std::vector<std::string> notes;
  for (const std::string& file : o.materials) materials.read(file, notes);
  if (o.material) request.material = materials.find(*o.material, "--material");
  if (!o.quiet)
    for (const std::string& note : notes) print_note(note);
  if (o.model) request.file = *o.model;
  else if (!o.material)
    throw UsageError("--material", "it is missing, and so is --model", "Say what the specimen is made of, as --material Si");
  if (o.energy) request.energy_ev = parse_energy_ev(*o.energy, "--energy");
  else if (!o.model)
    throw UsageError("--energy", "it is missing", "Say what the SEM image was taken with, as --energy 1keV");
  if (o.spot) {
    request.spot_nm = parse_length_nm(*o.spot, "--spot");
    request.spot_given = true;
  }
  const std::filesystem::path cache = io::cache_folder(o.cache.value_or(""));
  request.folder = cache.empty() ? std::filesystem::path() : cache / "models";
  request.threads = parse_threads(o.threads);
  return request;
}

workflow::PoseOptions pose_options(const ChainOptions& o, const HeightField& afm, const PlacedImage& sem) {
  workflow::PoseOptions pose;
  const std::string objective = o.objective.value_or("correlation");
  if (objective == "correlation") pose.registration.objective = RegistrationObjective::correlation;
  else if (objective == "mutual-information") pose.registration.objective = RegistrationObjective::mutual_information;
  else
    throw UsageError("--objective", fmt::format("there is no objective '{}'", objective), "Choose correlation or mutual-information");
  if (o.landmarks_only && !o.landmarks)
    throw UsageError("--landmarks-only", "there are no landmarks", "Add --landmarks FILE.csv");
  pose.landmarks_only = o.landmarks_only;
  if (o.landmarks) {
    pose.landmarks = io::read_landmarks(*o.landmarks, sem, place_of(afm));
    fit_landmarks(pose.landmarks);   // complains of too few, or on a line, before any work
  }
  return pose;
}

std::vector<std::string> input_words(const ChainOptions& o) {
  std::vector<std::string> words;
  for (const auto& [parameter, texts] : o.bound.given())
    if (parameter != "level.method") words.insert(words.end(), {o.bound.looks.at(parameter).name, texts.back()});
  for (const auto& [value, option] :
       {std::pair{&o.sem_channel, "--sem-channel"}, std::pair{&o.sem_pixel_size, "--sem-pixel-size"}})
    if (value->has_value()) words.insert(words.end(), {option, **value});
  if (!o.afm.empty())
    words.insert(words.end(), {"--level-method", record_of(level_parameters(o)).at("level.method")});
  return words;
}

void print_pose(const workflow::Pose& pose, double sem_pixel_nm) {
  const auto line = [](const char* label, const std::string& text) { print("{:<10} {}\n", label, text); };
  const AffineParts p = parts_of(pose.sem_to_afm);
  line("map", fmt::format("SEM to AFM: turn {:.3f} deg, scale {:.5f} x {:.5f}, shear {:.5f}", p.rotation_rad / degrees_to_radians,
                          p.scale_x, p.scale_y, p.shear));
  const Affine& m = pose.sem_to_afm;
  if (!pose.registration) {
    line("", fmt::format("x' = {:.6f} x {:+.6f} y {:+.2f} nm", m.xx, m.xy, m.x0));
    line("", fmt::format("y' = {:.6f} x {:+.6f} y {:+.2f} nm", m.yx, m.yy, m.y0));
    return;
  }
  const Registration& r = *pose.registration;
  const auto error = [&](std::size_t i) { return std::sqrt(std::max(r.covariance[7 * i], 0.0)); };
  line("", fmt::format("x' = ({:.6f} ± {:.1g}) x + ({:.6f} ± {:.1g}) y + ({:.2f} ± {:.2g}) nm", m.xx, error(0), m.xy, error(1),
                       m.x0, error(2)));
  line("", fmt::format("y' = ({:.6f} ± {:.1g}) x + ({:.6f} ± {:.1g}) y + ({:.2f} ± {:.2g}) nm", m.yx, error(3), m.yy, error(4),
                       m.y0, error(5)));
  line("place", fmt::format("± {:.2g} SEM pixels ({}); {:.0f} % of the SEM image lies on the scan", r.stderr_px,
                            format_length(r.stderr_px * sem_pixel_nm), 100 * r.overlap));
  line("score", fmt::format("{:.4f}", r.score));
  line("verdict", fmt::format("{}{}{}", workflow::name(r.verdict), r.reason.empty() ? "" : ": ", r.reason));
  for (const RegistrationRival& rival : r.rivals) {
    const AffineParts q = parts_of(rival.sem_to_afm);
    line("rival", fmt::format("score {:.4f}, turn {:.1f} deg, shift {:.0f}, {:.0f} nm; {:.1f} pixels away", rival.score,
                              q.rotation_rad / degrees_to_radians, q.shift_x_nm, q.shift_y_nm, rival.distance_px));
  }
}

void add_chain_inputs(CLI::App& app, ChainOptions& o) {
  const char* inputs = "Inputs";
  o.bound.looks["scan.height_channel"].name = "--afm-channel";
  o.bound.looks["scan.height_unit"].name = "--afm-z-unit";
  o.bound.looks["scan.height_pitch"].name = "--afm-pixel-size";
  o.bound.add<io::HeightReadOptions>(app, inputs);
  app.add_option("--sem-channel", o.sem_channel, "Channel of the SEM image, by name (the first)")
      ->type_name("NAME")->group(inputs);
  app.add_option("--sem-pixel-size", o.sem_pixel_size, "Of the SEM image (from the microscope's metadata)")
      ->type_name("LENGTH")->group(inputs);
}

void add_preparation_options(CLI::App& app, ChainOptions& o) {
  const char* group = "AFM scan (each step is found if it is not said)";
  o.bound.looks["level.method"].name = "--level-method";
  o.bound.looks["level.degree"].name = "--level-degree";
  o.bound.looks["level.rows"].name = "--rows";
  o.bound.add<workflow::LevelParameters>(app, group, {}, {"level.method", "level.degree", "level.rows"});
  app.add_flag("--no-level", o.no_level, "The scan is level")->group(group);
  app.add_option("--tip", o.tip, "A file, or a shape as in 'semsurf tip': cone:10nm,15deg (found blindly,\n"
                                 "taken as round)")
      ->type_name("FILE")->option_text("FILE|SHAPE")->group(group);
  CLI::Option* size = app.add_option("--tip-size", o.tip_size,
                                     "Samples across a blind tip of any shape, odd (a round one)");
  size->type_name("N")->group(group);
  o.bound.stands_for(size, "tip.size");
  CLI::Option* noise = app.add_option("--afm-noise", o.afm_noise,
                                      "Correlation of neighbours and variance of the innovation in nm^2\n"
                                      "(estimated, as 'semsurf noise scan' does)");
  noise->type_name("ALPHA,INNOVATION")->group(group);
  o.bound.stands_for(noise, "scan.height_noise");
}

void add_model_request(CLI::App& app, ChainOptions& o) {
  const char* group = "SEM image";
  app.add_option("--material", o.material, "What the specimen is made of")->type_name("MATERIAL")->group(group);
  add_materials_option(app, o.materials)->group(group);
  app.add_option("--energy", o.energy, "Of the beam, 100eV to 30keV")->type_name("ENERGY")->group(group);
  app.add_option("--spot", o.spot, "Standard deviation of the Gaussian spot (0nm)")->type_name("LENGTH")->group(group);
  app.add_option("--model", o.model, "The fast model, as 'semsurf train' writes it (one that was kept is\n"
                                     "taken, else one is trained and kept)")
      ->type_name("FILE.json")->group(group);
  app.add_option("--cache", o.cache, "Folder that models are kept in (see 'semsurf library --help')")
      ->type_name("FOLDER")->group(group);
}

void add_pose_options(CLI::App& app, ChainOptions& o) {
  const char* group = "Registration";
  app.add_option("--landmarks", o.landmarks, "Places seen in both images, to start from: CSV with a first line\n"
                                             "sem_x_px,sem_y_px,afm_x_px,afm_y_px, or _nm, or sem_col_px,sem_row_px\n"
                                             "counted from the top left (none are needed)")
      ->type_name("FILE.csv")->group(group);
  app.add_flag("--landmarks-only", o.landmarks_only, "The landmarks' map is not refined by the images")->group(group);
  app.add_option("--objective", o.objective, "What is largest where the images agree (correlation)")
      ->type_name("correlation|mutual-information")->group(group);
}

}  // namespace surf::cli
