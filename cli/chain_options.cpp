// SPDX-License-Identifier: GPL-3.0-or-later
#include "chain_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "afm_options.h"
#include "common_options.h"
#include "sem_input.h"
#include "surf/core/error.h"
#include "surf/core/some_parameters.h"
#include "surf/core/units.h"
#include "surf/io/cache.h"
#include "surf/io/landmarks_file.h"
#include "surf/io/tip_file.h"
#include "surf/workflow/picture_input.h"
#include "surf/workflow/tip_job.h"
#include "terminal.h"

namespace surf::cli {
namespace {

using workflow::LevelMethod;

/// "ALPHA,INNOVATION", the innovation in nm^2.
AfmNoise parse_afm_noise(const std::string& text) {
  const auto numbers = parse_values(text, {.name = "number", .help = ""}, "--afm-noise");
  AfmNoise noise;
  if (numbers.size() == 2) noise = {numbers[0], numbers[1]};
  try {
    if (numbers.size() != 2) throw InvalidInput("", "", "");
    validate(noise);
  } catch (const InvalidInput&) {
    throw UsageError("--afm-noise", fmt::format("'{}' is no noise", text),
                     "Give alpha, below 1, and the variance of the innovation in nm^2, as 0.8,0.2; "
                     "'semsurf noise scan' finds them");
  }
  return noise;
}

/// A file, or a shape with or without "shape:" before it.
Tip read_tip_option(std::string text, int size, const HeightField& scan) {
  const bool named = text.starts_with("shape:");
  if (named) text.erase(0, 6);
  const bool shape =
      named || std::ranges::any_of(
                   std::initializer_list<const char*>{"parabola:", "cone:", "pyramid:", "ball:"},
                   [&](const char* kind) { return text.starts_with(kind); });
  if (!shape) return io::read_tip(text);
  const int shorter = std::min(scan.z_nm.width(), scan.z_nm.height());
  const int usual = std::min(41, shorter / 2 * 2 - 1);
  return workflow::tip_by_shape({workflow::parse_tip_shape(text, "`reconstruction.tip`"),
                                 size ? size : usual, scan.pitch_x_nm, scan.pitch_y_nm},
                                "`reconstruction.tip`");
}

void take_level(const ChainOptions& o, workflow::LevelParameters& level) {
  if (o.no_level && o.bound.is_given("level.method"))
    throw UsageError("--no-level", "with --level-method there are two ways",
                     "Leave out one of the two");
  if (o.no_level) level.method = LevelMethod::none;
  if (o.bound.is_given("level.degree") && level.method != LevelMethod::polynomial)
    throw UsageError("--level-degree", "only a polynomial has one",
                     "Add --level-method polynomial");
}

/// Where the samples of a scan lie, for its pixels.
PlacedImage place_of(const HeightField& f) { return {f.placement(), f.z_nm, f.valid}; }

}  // namespace

void describe(ParameterVisitor& visit, ChainFiles& files) {
  visit(files.afm, {.name = "reconstruction.afm",
                    .help = "The AFM scan, of any format",
                    .form = "FILE",
                    .file = FileRole::read});
  visit(files.sem, {.name = "reconstruction.sem",
                    .help = "The SEM image; further ones are of the same place from other sides",
                    .form = "FILE",
                    .file = FileRole::read});
  visit(files.tip, {.name = "reconstruction.tip",
                    .help = "The tip: a file, or a shape as in 'semsurf tip', cone:10nm,15deg",
                    .otherwise = "found blindly, taken as round",
                    .form = "FILE|SHAPE",
                    .file = FileRole::read});
  describe(visit, files.material);
  visit(files.landmarks, {.name = "registration.landmarks",
                          .help = "Landmarks seen in both images, to start from: CSV with a first "
                                  "line sem_x_px,sem_y_px,afm_x_px,afm_y_px, or _nm, or "
                                  "sem_col_px,sem_row_px counted from the top left",
                          .otherwise = "none are needed",
                          .form = "FILE.csv",
                          .file = FileRole::read});
}

void take_afm(const ChainOptions& o, const ChainFiles& files, workflow::AfmInput& afm) {
  workflow::AfmPreparationOptions& p = afm.preparation;
  take_level(o, p.level);
  if (o.afm_noise && p.noise)
    throw UsageError("--afm-noise", "with --height-noise there are two ways",
                     "Leave out one of the two");
  if (o.afm_noise) p.noise = parse_afm_noise(*o.afm_noise);
  afm.scan = read_scan(files.afm, afm.reading, o.quiet).field;
  afm.file = files.afm;
  if (!files.tip.empty()) p.tip = read_tip_option(files.tip, p.tip_size, afm.scan);
}

void take_sem(const ChainOptions& o, const std::string& file, workflow::SemInput& sem) {
  sem = read_sem_channel(file, sem.reading, o.quiet);
}

void take_model(const ChainOptions& o, const ChainFiles& files, int threads,
                workflow::ModelRequest& model) {
  if (!files.material.name.empty()) model.material = read_material(files.material, o.quiet);
  if (model.file.empty() && files.material.name.empty())
    throw UsageError("`specimen.material`", "it is missing, and so is `reconstruction.model`",
                     "Say what the specimen is made of, as `specimen.material=Si`");
  if (model.file.empty() && !o.bound.is_given("beam.energy"))
    throw UsageError("`beam.energy`", "it is missing",
                     "Say what the SEM image was taken with, as `beam.energy=1keV`");
  if (!o.bound.is_given("job.cache")) {
    const std::filesystem::path cache = io::cache_folder();
    model.folder = cache.empty() ? cache : cache / "models";
  }
  model.threads = threads;
}

void take_pose(const ChainOptions& o, const ChainFiles& files, const HeightField& afm,
               const PlacedImage& sem, workflow::PoseOptions& pose) {
  if (pose.transform && !files.landmarks.empty())
    throw UsageError("`registration.transform`", "landmarks are given, too",
                     "Leave out one of the two");
  if (!pose.transform_doubt.empty() && !pose.accept_unverified)
    throw UsageError(o.bound.given().find("registration.transform")->second.back(),
                     fmt::format("its registration is not verified ({})", pose.transform_doubt),
                     "Look at 'semsurf register --picture'; `registration.accept_registration` "
                     "takes it all the same");
  if (pose.landmarks_only && files.landmarks.empty())
    throw UsageError("`registration.landmarks_only`", "there are no landmarks",
                     "Add `registration.landmarks=FILE.csv`");
  if (files.landmarks.empty()) return;
  pose.landmarks = io::read_landmarks(files.landmarks, sem, place_of(afm));
  fit_landmarks(pose.landmarks);  // complains of too few, or on a line, before any work
}

void print_pose(const workflow::Pose& pose, double sem_pixel_nm) {
  const auto line = [](const char* label, const std::string& text) {
    print("{:<10} {}\n", label, text);
  };
  const AffineParts p = parts_of(pose.sem_to_afm);
  line("map", fmt::format("SEM to AFM: turn {:.3f} deg, scale {:.5f} x {:.5f}, shear {:.5f}",
                          p.rotation_rad / degrees_to_radians, p.scale_x, p.scale_y, p.shear));
  const Affine& m = pose.sem_to_afm;
  if (!pose.registration) {
    line("", fmt::format("x' = {:.6f} x {:+.6f} y {:+.2f} nm", m.xx, m.xy, m.x0));
    line("", fmt::format("y' = {:.6f} x {:+.6f} y {:+.2f} nm", m.yx, m.yy, m.y0));
    return;
  }
  const Registration& r = *pose.registration;
  const auto error = [&](std::size_t i) { return std::sqrt(std::max(r.covariance[7 * i], 0.0)); };
  line("", fmt::format("x' = ({:.6f} ± {:.1g}) x + ({:.6f} ± {:.1g}) y + ({:.2f} ± {:.2g}) nm",
                       m.xx, error(0), m.xy, error(1), m.x0, error(2)));
  line("", fmt::format("y' = ({:.6f} ± {:.1g}) x + ({:.6f} ± {:.1g}) y + ({:.2f} ± {:.2g}) nm",
                       m.yx, error(3), m.yy, error(4), m.y0, error(5)));
  line("place",
       fmt::format("± {:.2g} SEM pixels ({}); {:.0f} % of the SEM image lies on the scan",
                   r.stderr_px, format_length(r.stderr_px * sem_pixel_nm), 100 * r.overlap));
  line("score", fmt::format("{:.4f}", r.score));
  line("verdict",
       fmt::format("{}{}{}", workflow::name(r.verdict), r.reason.empty() ? "" : ": ", r.reason));
  for (const RegistrationRival& rival : r.rivals) {
    const AffineParts q = parts_of(rival.sem_to_afm);
    line("rival",
         fmt::format("score {:.4f}, turn {:.1f} deg, shift {:.0f}, {:.0f} nm; {:.1f} pixels away",
                     rival.score, q.rotation_rad / degrees_to_radians, q.shift_x_nm, q.shift_y_nm,
                     rival.distance_px));
  }
}

void add_chain_options(CLI::App& app, ChainOptions& o) {
  const char *inputs = "Inputs", *scan = "AFM scan (each step is found if it is not said)",
             *sem = "SEM image";
  const char *pose = "Registration", *surface = "Reconstruction", *output = "Output";
  o.bound.headings = {{"reconstruction.afm", inputs},
                      {"reconstruction.sem", inputs},
                      {"scan", inputs},
                      {"scan.height_noise", scan},
                      {"level", scan},
                      {"reconstruction.tip", scan},
                      {"reconstruction.tip_size", scan},
                      {"specimen", sem},
                      {"beam", sem},
                      {"job", sem},
                      {"simulation", sem},
                      {"reconstruction.model", sem},
                      {"reconstruction.gains", sem},
                      {"reconstruction.offset", sem},
                      {"reconstruction.calibration", sem},
                      {"reconstruction.sem_noise", sem},
                      {"registration", pose},
                      {"reconstruction", surface},
                      {"tip", output},
                      {"reconstruction.truth", output},
                      {"output", output},
                      {"job.threads", output}};
  OptionLooks& looks = o.bound.looks;
  looks["scan.height_channel"] = {.former = {"--afm-channel"}};
  looks["scan.height_unit"] = {.former = {"--afm-z-unit"}};
  looks["scan.height_pitch"] = {.former = {"--afm-pixel-size"}};
  looks["scan.pixel_size"] = {.former = {"--sem-pixel-size"}};
  looks["level.method"] = {.name = "--level-method"};
  looks["level.degree"] = {.name = "--level-degree"};
  looks["level.tolerance"] = {.name = "--level-tolerance"};
  looks["reconstruction.optimiser"] = {.former = {"--method"}};
  looks["reconstruction.optimiser_tolerance"] = {.former = {"--tolerance"}};
  looks["output"] = {.name = "-o,--output"};
  app.add_flag("--no-level", o.no_level, "The scan is level")->group("");
  app.add_option("--afm-noise", o.afm_noise,
                 "Correlation of neighbours and variance of the innovation in nm^2")
      ->group("");
}

}  // namespace surf::cli
