// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruct_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "common_options.h"
#include "options.h"
#include "surf/core/error.h"
#include "surf/io/calibration_file.h"
#include "surf/io/height_field_file.h"
#include "surf/io/transform_file.h"

namespace surf::cli {
namespace {

constexpr const char* examples =
    R"(Does all of it: levels the scan, finds its noise and its tip, takes the tip off, trains a fast model of SEM images
or takes one that was kept, registers, calibrates, and finds the surface that makes both images most likely, with
its uncertainty. Each step can be overridden; FOLDER/report.json says what was used and how to repeat it, and
FOLDER/panel.png shows everything: begin there. docs/reconstruction.md explains it.
Ctrl-C or a crash loses one scale at most: the same command goes on.
Exit code 4: there is a result but not to be trusted (the report's "reasons"), or the registration is not verified.

Examples:
  semsurf reconstruct --afm scan.gwy --sem image.tif --material Si --energy 1keV -o result
  semsurf reconstruct --afm scan.gwy --sem image.png --sem-pixel-size 10nm --model si.json --landmarks places.csv -o result
  semsurf reconstruct --afm scan.gwy --sem image.tif --model si.json --transform transform.json --tip tip.gsf -o result
  semsurf reconstruct --afm scan.gwy -o result
  semsurf reconstruct --sem image.tif --model si.json --gains 900,300 --offset 120 -o result)";

/// A file, or six numbers.
io::TransformFile transform_of(const std::string& text) {
  const bool numbers = std::ranges::count(text, ',') == 5 && text.find_first_not_of("0123456789+-.,eE") == std::string::npos;
  if (!numbers) return io::read_transform(text);
  const std::vector<double> v = parse_numbers(text, "--transform");
  io::TransformFile file;
  file.sem_to_afm = {v[0], v[1], v[2], v[3], v[4], v[5]};
  try {
    inverse(file.sem_to_afm);
  } catch (const InvalidInput& error) {
    throw UsageError("--transform", error.reason(), error.remedy());
  }
  return file;
}

void take_pose(const ReconstructOptions& o, workflow::ReconstructJob& job) {
  if (!job.afm || !job.sem) {
    for (const auto& [given, option] : {std::pair{o.transform.has_value(), "--transform"},
                                        std::pair{o.chain.landmarks.has_value(), "--landmarks"}})
      if (given) throw UsageError(option, "there is one image only", "Leave it out, or give both --afm and --sem");
    return;
  }
  if (o.transform && o.chain.landmarks)
    throw UsageError("--transform", "landmarks are given, too", "Leave out one of the two");
  job.pose = pose_options(o.chain, job.afm->scan, job.sem->image);
  job.pose.accept_unverified = o.accept_registration;
  if (!o.transform) return;
  const io::TransformFile file = transform_of(*o.transform);
  if (!file.verified && !o.accept_registration)
    throw UsageError(*o.transform, fmt::format("its registration is not verified ({})", file.verdict),
                     "Look at 'semsurf register --picture'; --accept-registration takes it all the same");
  job.pose.transform = file.sem_to_afm;
}

void take_calibration(const ReconstructOptions& o, workflow::ReconstructJob& job) {
  if (o.calibration && (o.gains || o.offset))
    throw UsageError("--calibration", "gains or an offset are given, too", "Leave one of them out");
  if (o.offset && !o.gains) throw UsageError("--offset", "without --gains it is fitted", "Add --gains, or leave it out");
  if (o.calibration) {
    const Calibration c = io::read_calibration(*o.calibration).calibration;
    job.calibration = {c.gains, c.offset};
  }
  if (o.gains) {
    job.calibration = {parse_numbers(*o.gains, "--gains"), o.offset ? parse_number(*o.offset, "--offset") : 0};
    if (std::ranges::all_of(job.calibration->gains, [](double g) { return g == 0; }))
      throw UsageError("--gains", "all are 0: the image would have nothing of the model", "Give one above 0 at least");
  }
  if (!o.sem_noise) return;
  const std::vector<double> line = parse_numbers(*o.sem_noise, "--sem-noise");
  if (line.size() < 2 || line.size() > 3)
    throw UsageError("--sem-noise", fmt::format("'{}' has {} numbers", *o.sem_noise, line.size()),
                     "Give slope and intercept of the variance, and its least value if you like, as 1.2,30");
  SemNoise noise{line[0], line[1], line.size() > 2 ? line[2] : 1e-12};
  try {
    validate(noise);
  } catch (const InvalidInput& error) {
    throw UsageError("--sem-noise", error.reason(), error.remedy());
  }
  job.sem_noise = noise;
}

double above_zero(const std::string& text, const char* option) {
  const double value = parse_number(text, option);
  if (!(value > 0)) throw UsageError(option, fmt::format("'{}' is not above 0", text), "Give a number above 0, or leave it out");
  return value;
}

ReconstructionMethod parse_method(const std::string& text) {
  for (const auto method : {ReconstructionMethod::gauss_newton, ReconstructionMethod::conjugate_gradients,
                            ReconstructionMethod::lbfgs})
    if (text == workflow::name(method)) return method;
  throw UsageError("--method", fmt::format("there is no method '{}'", text), "Choose gauss-newton, conjugate-gradients or lbfgs");
}

void take_reconstruction(const ReconstructOptions& o, workflow::ReconstructJob& job) {
  ReconstructionOptions& r = job.options;
  if (o.method) r.method = parse_method(*o.method);
  if (o.scales) {
    r.scales_px = parse_numbers(*o.scales, "--scales");
    for (std::size_t i = 0; i < r.scales_px.size(); ++i)
      if (!(r.scales_px[i] > 0) || (i > 0 && !(r.scales_px[i] < r.scales_px[i - 1])))
        throw UsageError("--scales", fmt::format("'{}' does not fall, or is not above 0", *o.scales), "Give pixels, as 16,8,4,2,1");
  }
  if (o.iterations) r.iterations = static_cast<int>(parse_whole(*o.iterations, "--iterations", 1, 1000000));
  if (o.tolerance) r.tolerance = above_zero(*o.tolerance, "--tolerance");
  if (o.prior) r.curvature_prior_per_nm = above_zero(*o.prior, "--prior");
  if (o.upsample) job.upsample = static_cast<int>(parse_whole(*o.upsample, "--upsample", 1, 8));
  if (o.probes) r.probes = static_cast<int>(parse_whole(*o.probes, "--probes", 2, 100000));
  r.refine_transform = !o.fixed_transform;
  r.refine_calibration = !o.fixed_calibration;
  if (o.keep_tip && o.refine_tip) throw UsageError("--keep-tip", "with --refine-tip it contradicts itself", "Leave one of them out");
  if (o.refine_tip && r.method != ReconstructionMethod::gauss_newton)
    throw UsageError("--refine-tip", "only Gauss-Newton fits the tip", "Leave out --method, or --refine-tip");
  if (o.keep_tip || o.refine_tip) job.refine_tip = o.refine_tip;
  r.uncertainty = !o.no_uncertainty;
  if (o.chain.seed) r.seed = parse_seed(*o.chain.seed, "--seed");
  r.threads = parse_threads(o.chain.threads);
}

}  // namespace

workflow::ReconstructJob make_reconstruct_job(const ReconstructOptions& o) {
  if (!o.output) throw UsageError("--output", "no folder for the result is given", "Add -o result");
  if (o.chain.afm.empty() && o.chain.sem.empty())
    throw UsageError("reconstruct", "neither a scan nor an SEM image is given", "Add --afm scan.gwy, --sem image.tif, or both");
  workflow::ReconstructJob job;
  job.folder = *o.output;
  while (job.folder.filename().empty() && job.folder.has_parent_path()) job.folder = job.folder.parent_path();   // result/
  job.picture = !o.no_picture;
  take_reconstruction(o, job);
  take_calibration(o, job);
  if (!o.chain.sem.empty()) job.model = model_request(o.chain);
  if (!o.chain.afm.empty()) job.afm = read_afm(o.chain);
  if (!o.chain.sem.empty()) job.sem = read_sem(o.chain);
  take_pose(o, job);
  if (o.truth) {
    job.truth = io::read_height_field(*o.truth).field;
    job.truth_file = *o.truth;
  }
  job.fixed_options = input_words(o.chain);
  return job;
}

void add_reconstruct_options(CLI::App& app, ReconstructOptions& o) {
  const char* inputs = "Inputs";
  app.add_option("--afm", o.chain.afm, "The AFM scan, of any format")->type_name("FILE")->group(inputs);
  app.add_option("--sem", o.chain.sem, "The SEM image; either of the two may be missing")->type_name("FILE")->group(inputs);
  add_chain_inputs(app, o.chain);
  add_preparation_options(app, o.chain);
  add_model_request(app, o.chain);
  const char* sem = "SEM image";
  app.add_option("--gains", o.gains, "Of each channel of the model, commas between (fitted)")->type_name("N,N")->group(sem);
  app.add_option("--offset", o.offset, "Of the grey levels, with --gains (0)")->type_name("NUMBER")->group(sem);
  app.add_option("--calibration", o.calibration, "Instead: gains and offset as 'semsurf calibrate' writes them")
      ->type_name("FILE.json")->group(sem);
  app.add_option("--sem-noise", o.sem_noise, "Line of the variance by the grey level: slope, intercept and, if it\n"
                                             "matters, least variance (estimated from flat places)")
      ->type_name("SLOPE,INTERCEPT")->group(sem);
  add_pose_options(app, o.chain);
  const char* pose = "Registration";
  app.add_option("--transform", o.transform, "The map, as 'semsurf register' writes it, or xx,xy,x0,yx,yy,y0 in nm")
      ->type_name("FILE.json")->group(pose);
  app.add_flag("--accept-registration", o.accept_registration, "Go on where the registration is not verified")->group(pose);
  const char* optimiser = "Reconstruction";
  const ReconstructionOptions usual;
  app.add_option("--method", o.method, "How the surface is searched for (gauss-newton)")
      ->type_name("gauss-newton|conjugate-gradients|lbfgs")->group(optimiser);
  app.add_option("--scales", o.scales, "Standard deviations of the Gaussians that the surface is a sum of,\n"
                                       "falling, in pixels (the method's own)")
      ->type_name("PX,PX...")->group(optimiser);
  app.add_option("--iterations", o.iterations, "Of each scale, at most (the method's own)")->type_name("N")->group(optimiser);
  app.add_option("--tolerance", o.tolerance, "Per pixel: a scale ends when an iteration gains less (the method's own)")
      ->type_name("NUMBER")->group(optimiser);
  app.add_option("--prior", o.prior, "Expected second derivative of the surface where no image says\n"
                                     "anything, 1/nm (0.001, more on rough ground)")
      ->type_name("NUMBER")->group(optimiser);
  app.add_option("--upsample", o.upsample, fmt::format("Samples of the dilation in each of the scan's pixels, 1 to 8 ({})",
                                                 workflow::ReconstructJob{}.upsample))
      ->type_name("N")->group(optimiser);
  app.add_flag("--fixed-transform", o.fixed_transform, "The map is not fitted further with the surface")->group(optimiser);
  app.add_flag("--fixed-calibration", o.fixed_calibration, "Nor are gains and offset")->group(optimiser);
  app.add_flag("--keep-tip", o.keep_tip, "Nor is the tip that was found in the scan")->group(optimiser);
  app.add_flag("--refine-tip", o.refine_tip, "The tip is fitted with the surface, even the one of --tip")->group(optimiser);
  app.add_flag("--no-uncertainty", o.no_uncertainty, "Without standard deviations of the heights, which take a while")
      ->group(optimiser);
  app.add_option("--probes", o.probes, fmt::format("Random vectors that the uncertainty is estimated from ({})", usual.probes))->type_name("N")->group(optimiser);
  app.add_option("--seed", o.chain.seed, fmt::format("Of these, and of the noise that tips are judged by ({})", usual.seed))->type_name("N")->group(optimiser);
  const char* output = "Output";
  app.add_option("-o,--output", o.output, "Folder for all results; it is made")->type_name("FOLDER")->group(output);
  app.add_option("--truth", o.truth, "Heights in the SEM's frame, to compare the result with")->type_name("FILE")->group(output);
  app.add_flag("--no-picture", o.no_picture, "Without panel.png, which needs Python with Matplotlib")->group(output);
  add_threads_option(app, o.chain.threads)->group(output);
  add_quiet_flag(app, o.chain.quiet)->group(output);
  app.footer(examples);
}

}  // namespace surf::cli
