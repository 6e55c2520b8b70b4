// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common_parameters.h"
#include "surf/core/error.h"
#include "surf/core/some_parameters.h"
#include "surf/core/units.h"
#include "surf/core/words.h"
#include "surf/io/cache.h"
#include "surf/io/scan_parameters.h"
#include "surf/io/transform_file.h"
#include "surf/mc/geometry/largest_length.h"
#include "surf/mc/physics/physics.h"
#include "surf/workflow/reconstruct_job.h"
#include "surf/workflow/tip_job.h"

namespace surf::workflow {
namespace {

std::vector<double> numbers_of(std::string_view text, const std::string& subject) {
  return parse_values(text, {.name = "number", .help = ""}, subject);
}

/// Reads the name of a file, or six numbers.
void read_transform(std::string_view text, const std::string& subject, PoseOptions& pose) {
  pose.transform_doubt.clear();
  if (std::ranges::count(text, ',') != 5) {
    const io::TransformFile file = io::read_transform(std::string(text));
    pose.transform = file.sem_to_afm;
    if (!file.verified) pose.transform_doubt = file.verdict.empty() ? "unknown" : file.verdict;
    return;
  }
  const std::vector<double> v = numbers_of(text, subject);
  pose.transform = Affine{v[0], v[1], v[2], v[3], v[4], v[5]};
  try {
    inverse(*pose.transform);
  } catch (const InvalidInput& error) {
    throw UsageError(subject, error.reason(), error.remedy());
  }
}

SemNoise read_sem_noise(std::string_view text, const std::string& subject) {
  const std::vector<double> line = numbers_of(text, subject);
  if (line.size() < 2 || line.size() > 3)
    throw UsageError(
        subject, fmt::format("'{}' has {} numbers", text, line.size()),
        "Give slope and intercept of the variance, and its least value if you like, as 1.2,30");
  const SemNoise noise{line[0], line[1], line.size() > 2 ? line[2] : SemNoise{}.least_variance};
  try {
    validate(noise);
  } catch (const InvalidInput& error) {
    throw UsageError(subject, error.reason(), error.remedy());
  }
  return noise;
}

SemTilt read_tilt(std::string_view text, const std::string& subject) {
  std::vector<double> v = numbers_of(text, subject);
  if (v.size() == 2) v.resize(4, 0.0);
  if (v.size() != 4 || v[2] < 0 || v[3] < 0)
    throw UsageError(subject, fmt::format("'{}' is not two slopes and their standard errors", text),
                     "Give slopes along x and y, and their standard errors if you like, as "
                     "0.001,-0.002,1e-4,1e-4");
  return {v[0], v[1], {v[2], v[3]}};
}

std::vector<double> read_gains(std::string_view text, const std::string& subject) {
  std::vector<double> gains = numbers_of(text, subject);
  if (std::ranges::all_of(gains, [](double gain) { return gain == 0; }))
    throw UsageError(subject, "all are 0: the image would have nothing of the model",
                     "Give one above 0 at least");
  return gains;
}

void describe_calibration(ParameterVisitor& visit, std::optional<GivenCalibration>& calibration) {
  visit.form(
      {.name = "reconstruction.gains",
       .help = "Gain of each channel of the model",
       .otherwise = "fitted",
       .form = "N,N"},
      [&] { return calibration ? exact_list(calibration->gains) : std::string(); },
      [&](std::string_view text, const std::string& subject) {
        calibration = {read_gains(text, subject), 0};
      });
  std::optional<double> offset;
  if (calibration && !visit.reads()) offset = calibration->offset;
  visit(offset, {.name = "reconstruction.offset",
                 .help = "Offset of the grey levels, where gains are given",
                 .otherwise = "0"});
  if (!visit.reads() || !offset) return;
  if (!calibration)
    throw UsageError("`reconstruction.offset`", "without `reconstruction.gains` it is fitted",
                     "Add `reconstruction.gains`, or leave it out");
  calibration->offset = *offset;
}

template <class T>
std::string texts_of(const std::vector<T>& list, const std::function<std::string(const T&)>& text) {
  std::string all;
  for (const T& one : list) all += (all.empty() ? "" : ";") + text(one);
  return all;
}

/// What is known of each further image: several numbers each, with semicolons between images.
template <class T>
void describe_known(ParameterVisitor& visit, std::vector<T>& list, Parameter about,
                    std::function<std::string(const T&)> write,
                    std::function<T(std::string_view, const std::string&)> read) {
  about.otherwise = "found";
  about.level = Level::advanced;
  visit.form(
      about, [&list, write] { return texts_of<T>(list, write); },
      [&list, read](std::string_view text, const std::string& subject) {
        for (const std::string_view one : split(text, ";")) list.push_back(read(one, subject));
      },
      FieldKind::list);
}

void describe_known(ParameterVisitor& visit, KnownViews& views) {
  visit.form(
      {.name = "reconstruction.view_model",
       .help = "Fast model for each SEM image, or for each after the first",
       .otherwise = "as for the first",
       .form = "FILE.json",
       .recorded = false,
       .file = FileRole::read},
      [&] {
        std::string text;
        for (const std::filesystem::path& file : views.models)
          text += (text.empty() ? "" : " ") + file.string();
        return text;
      },
      [&](std::string_view text, const std::string&) { views.models.emplace_back(text); },
      FieldKind::list);
  describe_known<std::vector<double>>(
      visit, views.gains,
      {.name = "reconstruction.view_gains",
       .help = "Gains of the model's channels, then the offset, of each SEM image after the first",
       .form = "N,N,OFFSET"},
      [](const std::vector<double>& v) { return exact_list(v); },
      [](std::string_view text, const std::string& subject) { return numbers_of(text, subject); });
  describe_known<SemNoise>(
      visit, views.noises,
      {.name = "reconstruction.view_noise",
       .help = "Noise of each SEM image after the first, as `reconstruction.sem_noise`",
       .form = "SLOPE,INTERCEPT"},
      [](const SemNoise& n) {
        return exact_list({n.slope, n.intercept, n.least_variance});
      },
      [](std::string_view text, const std::string& subject) {
        return read_sem_noise(text, subject);
      });
  describe_known<Point2>(
      visit, views.places_nm,
      {.name = "reconstruction.view_place",
       .help = "Shift of each SEM image after the first in the plane that it sees, in nm, to start "
               "from",
       .form = "X,Y"},
      [](const Point2& p) {
        return exact_list({p.x, p.y});
      },
      [](std::string_view text, const std::string& subject) {
        const std::vector<double> v = numbers_of(text, subject);
        if (v.size() != 2)
          throw UsageError(subject, fmt::format("'{}' is not two numbers", text),
                           "Give a shift along x and along y in nm, as 12,-3");
        return Point2{v[0], v[1]};
      });
}

/// Whether the tip is fitted, as two flags. Without either, it depends on how the tip was found.
void describe_tip_fit(ParameterVisitor& visit, std::optional<bool>& refine) {
  bool keep = refine == false;
  visit(keep,
        {.name = "reconstruction.keep_tip",
         .help = "Keep the tip that was found in the scan instead of fitting it with the surface"});
  if (!visit.reads()) return;
  if (keep && refine == true)
    throw UsageError("`reconstruction.keep_tip`",
                     "with `reconstruction.refine_tip` it contradicts itself",
                     "Leave one of them out");
  if (keep) refine = false;
}

}  // namespace

void describe(ParameterVisitor& visit, AfmPreparationOptions& o) {
  describe(visit, o.level);
  describe_noise(visit, o.noise);
  std::optional<int> size = o.tip_size != 0 ? std::optional(o.tip_size) : std::nullopt;
  visit(size, {.name = "reconstruction.tip_size",
               .help = "Samples across a tip of any shape, odd",
               .limits = within(3, 1001),
               .otherwise = "a round tip of any size"});
  o.tip_size = size.value_or(0);
}

void describe(ParameterVisitor& visit, AfmInput& input) {
  describe(visit, input.reading);
  describe(visit, input.preparation);
}

void describe(ParameterVisitor& visit, SemInput& input) { describe(visit, input.reading); }

void describe(ParameterVisitor& visit, ModelRequest& request) {
  std::optional<double> energy_ev, spot_nm;
  if (request.energy_ev > 0) energy_ev = request.energy_ev;
  if (request.spot_given) spot_nm = request.spot_nm;
  visit(energy_ev, {.name = "beam.energy",
                    .help = "Energy of the beam",
                    .unit = Unit::ev,
                    .limits = within(mc::min_beam_energy_ev, mc::max_beam_energy_ev),
                    .otherwise = "as the model says"});
  visit(spot_nm, {.name = "beam.spot",
                  .help = "Standard deviation of the Gaussian spot; 0 is a point",
                  .unit = Unit::nm,
                  .limits = within(0, mc::largest_length_nm),
                  .otherwise = "0nm, or as the model says"});
  request.energy_ev = energy_ev.value_or(0);
  request.spot_given = spot_nm.has_value();
  request.spot_nm = spot_nm.value_or(request.spot_nm);
  mc::SimulationRequest simulation;
  simulation.physics = request.physics;
  describe_some(visit, simulation, {{"simulation.physics"}});
  request.physics = simulation.physics;
  describe_path(visit, request.file,
                {.name = "reconstruction.model",
                 .help = "Fast model, as 'semsurf train' writes it",
                 .otherwise = "one that was kept, else one is trained and kept",
                 .form = "FILE.json",
                 .recorded = false,
                 .file = FileRole::read});
  visit(request.signal,
        {.name = "reconstruction.signal",
         .help = "Signal of the SEM image: SE, BSE, a quadrant BSE-right, BSE-top, BSE-left, "
                 "BSE-bottom, or a detector as for 'semsurf simulate --detector'",
         .otherwise = "a mixture of SE and BSE",
         .form = "SIGNAL"});
  visit.form(
      {.name = "job.cache",
       .help = "Folder that models are kept in; 'semsurf library --help' tells more",
       .otherwise = "$SEMSURF_CACHE, ~/.cache/semsurf",
       .form = "FOLDER|off",
       .level = Level::advanced,
       .recorded = false},
      [&] { return request.folder.parent_path().string(); },
      [&](std::string_view text, const std::string&) {
        const std::filesystem::path cache = io::cache_folder(std::string(text));
        request.folder = cache.empty() ? cache : cache / "models";
      });
}

void describe(ParameterVisitor& visit, PoseOptions& pose) {
  visit(pose.registration.objective, {"correlation", "mutual-information"},
        {.name = "registration.objective",
         .help = "Measure of agreement that the registration maximises"});
  visit(pose.landmarks_only,
        {.name = "registration.landmarks_only",
         .help = "Keep the landmarks' map instead of refining it by the images"});
  visit.form(
      {.name = "registration.transform",
       .help =
           "Map that is known: a file as 'semsurf register' writes it, or xx,xy,x0,yx,yy,y0 in nm",
       .otherwise = "searched for",
       .form = "FILE.json",
       .file = FileRole::read},
      [&] {
        if (!pose.transform) return std::string();
        const Affine& m = *pose.transform;
        return exact_list({m.xx, m.xy, m.x0, m.yx, m.yy, m.y0});
      },
      [&](std::string_view text, const std::string& subject) {
        read_transform(text, subject, pose);
      });
  visit(pose.accept_unverified,
        {.name = "registration.accept_registration",
         .help = "Accept a registration even where the images seem to show different places"});
}

void describe(ParameterVisitor& visit, RegisterJob& job) {
  describe(visit, job.afm);
  describe(visit, job.sem);
  describe(visit, job.model);
  describe(visit, job.pose);
  visit(job.afm.preparation.seed,
        {.name = "tip.seed", .help = "Seed of the noise that tips are judged by"});
  describe_path(visit, job.transform,
                {.name = "output",
                 .help = "The map, which 'semsurf reconstruct --transform' takes",
                 .form = "FILE.json",
                 .recorded = false,
                 .file = FileRole::written});
  describe_path(visit, job.picture,
                {.name = "output.picture",
                 .help = "Picture of both images, and of a checkerboard of them: .png .svg",
                 .form = "FILE",
                 .recorded = false,
                 .file = FileRole::written});
  describe_threads(visit, job.threads);
}

void describe(ParameterVisitor& visit, ReconstructJob& job) {
  if (job.afm) describe(visit, *job.afm);
  if (job.sem) {
    describe(visit, *job.sem);
    describe(visit, job.model);
    describe(visit, job.view_settings);
    describe_known(visit, job.known_views);
    describe_calibration(visit, job.calibration);
    visit.form(
        {.name = "reconstruction.sem_noise",
         .help = "Noise variance as a line over the grey level: its slope, its intercept and, "
                 "optionally, the least variance",
         .otherwise = "estimated from flat places",
         .form = "SLOPE,INTERCEPT"},
        [&] {
          const auto& n = job.sem_noise;
          return n ? exact_list({n->slope, n->intercept, n->least_variance}) : std::string();
        },
        [&](std::string_view text, const std::string& subject) {
          job.sem_noise = read_sem_noise(text, subject);
        });
    visit(job.model_error,
          {.name = "reconstruction.model_error",
           .help = "Expected error of the model of SEM images, as a share of the image's contrast, "
                   "because of other physics, another detector or contamination",
           .unit = Unit::share,
           .limits = within(0, 1)});
    visit(job.line_jitter_px, {.name = "reconstruction.line_jitter",
                               .help = "Standard deviation of displacements of the SEM image's "
                                       "rows along themselves, in pixels",
                               .limits = within(0, 5)});
    visit(job.film,
          {.name = "reconstruction.film",
           .help = "Material of a film of 1 to 2 nm on the specimen, as SiO2 or C, whose thickness "
                   "is found; gains and offset must be known",
           .otherwise = "none",
           .form = "MATERIAL"});
    visit(job.corrections,
          {.name = "reconstruction.corrections",
           .help = "Largest number of rounds in which Monte Carlo images of the surface correct "
                   "the model of SEM images; rounds end when the surface no longer moves",
           .limits = within(0, 10)});
    visit(job.correction_electrons, {.name = "reconstruction.correction_electrons",
                                     .help = "Primaries per pixel of these images",
                                     .limits = within(2, 1'000'000),
                                     .level = Level::advanced});
  }
  if (job.afm && job.sem) {
    describe(visit, job.pose);
    visit.form(
        {.name = "reconstruction.scan_tilt",
         .help = "Slopes to add to the levelled scan along its axes, nm per nm, and their "
                 "standard errors",
         .otherwise = "found with the SEM image",
         .form = "X,Y[,DX,DY]",
         .level = Level::advanced},
        [&] {
          const auto& t = job.tilt;
          return t ? exact_list({t->x, t->y, t->doubt.x, t->doubt.y}) : std::string();
        },
        [&](std::string_view text, const std::string& subject) {
          job.tilt = read_tilt(text, subject);
        });
  }
  ReconstructionOptions options = job.options;
  options.refine_tip = job.refine_tip.value_or(false);
  describe(visit, options);
  const std::optional<bool> refine = options.refine_tip       ? std::optional(true)
                                     : job.refine_tip == true ? std::nullopt
                                                              : job.refine_tip;
  options.refine_tip = job.options.refine_tip;
  job.options = options;
  job.refine_tip = refine;
  describe_tip_fit(visit, job.refine_tip);
  if (job.afm) {
    visit(job.upsample, {.name = "reconstruction.upsample",
                         .help = "Samples of the dilation in each of the scan's pixels",
                         .limits = within(1, 8)});
    if (visit.reads()) job.afm->preparation.seed = job.options.seed;
  }
  describe_folder(visit, job.folder, "Folder for all results, created if it is missing");
  describe_picture(visit, job.picture);
  describe_threads(visit, job.options.threads);
}

}  // namespace surf::workflow
