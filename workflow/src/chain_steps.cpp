// SPDX-License-Identifier: GPL-3.0-or-later
#include "chain_steps.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "seen_from.h"
#include "sem_frame.h"
#include "surf/afm/resample.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/plot.h"

namespace surf::workflow {
namespace {

constexpr double square = 1e-3;  // relative; models demand the same of fields

}  // namespace

void begin(const Reporter& reporter, const char* stage) {
  if (reporter.cancelled()) throw Interrupted();
  reporter.stage(stage);
}

void check_results(const std::filesystem::path& folder, bool picture) {
  std::error_code ignored;
  if (std::filesystem::exists(folder, ignored) && !std::filesystem::is_directory(folder, ignored))
    throw UsageError("`output`", fmt::format("{} is no folder", folder.string()),
                     "Name a folder for all results, as `output=result`");
  if (picture && !folder.empty()) io::check_plot_target(folder / "panel.png");
}

void warn_of_tip(const PreparedAfm& prepared, const Reporter& reporter) {
  for (const std::string& warning : prepared.tip_warnings) reporter.warn("AFM: " + warning);
}

PreparedAfm prepare(const AfmInput& afm, int threads, const Reporter& reporter, bool of_tip) {
  begin(reporter, "AFM scan");
  AfmPreparationOptions options = afm.preparation;
  options.threads = threads;
  options.watch = reporter.watch();
  PreparedAfm prepared = prepare_afm(afm.scan, options);
  for (const std::string& note : prepared.notes) reporter.note("AFM: " + note);
  for (const std::string& warning : prepared.warnings) reporter.warn("AFM: " + warning);
  if (of_tip) warn_of_tip(prepared, reporter);
  return prepared;
}

StoredModel model_of(ModelRequest request, const PlacedImage& sem, const Reporter& reporter) {
  begin(reporter, "model");
  if (std::abs(sem.pitch_x_nm - sem.pitch_y_nm) > square * sem.pitch_x_nm)
    throw InvalidInput(
        "SEM image",
        fmt::format("its pixels are {:.6g} x {:.6g} nm, and models are for square ones",
                    sem.pitch_x_nm, sem.pitch_y_nm),
        "Resample it to square pixels, or correct `sem_pixel_size`");
  request.pixel_nm = sem.pitch_x_nm;
  return find_model(request, reporter);
}

PlacedImage simulated_view(const HeightField& surface, const ImageModel& model, double pixel_nm,
                           int threads) {
  const HeightField fine = resampled(surface, pixel_nm);
  ModelOptions options;
  options.threads = threads;
  const ModelImages images = model.predict(with_holes_filled(fine), options);
  PlacedImage view;
  view.values = images.front();
  for (std::size_t c = 1; c < images.size(); ++c)
    for (std::size_t i = 0; i < view.values.size(); ++i)
      view.values.data()[i] += images[c].data()[i];
  view.valid = fine.valid;
  view.placement() = fine.placement();
  return view;
}

/// By how many quarters the detectors of an image are turned clockwise in the scan's frame.
int clockwise(const Affine& sem_to_afm) {
  const double turn = std::atan2(sem_to_afm.yx, sem_to_afm.xx) / (0.5 * std::numbers::pi);
  return static_cast<int>(std::lround(4 - turn)) % 4;
}

/// A surface as detectors see it that are turned.
PlacedImage lit_view(const HeightField& surface, const ImageModel& model, int quarters,
                     double pixel_nm, int threads) {
  PlacedImage view = simulated_view(surface, model, pixel_nm, threads);
  if (quarters == 0) return view;
  ModelOptions options;
  options.threads = threads;
  view.values =
      seen_from(model, with_holes_filled(resampled(surface, pixel_nm)), quarters, options).front();
  return view;
}

/// How the scan is turned says where a detector at a side stands, which says how the surface is
/// lit: of the four ways the one that agrees with what it leads to, and best with the image.
void register_lit(const PreparedAfm& afm, const PlacedImage& sem, const StoredModel& model,
                  const RegistrationOptions& options, int threads, Pose& pose) {
  const auto rank = [](const Registration& r, int quarters) {
    const bool agrees = clockwise(r.sem_to_afm) == quarters;
    return (agrees ? 4 : 0) + (r.verdict == RegistrationVerdict::verified ? 2 : 0) + r.score;
  };
  double best = 0;
  for (int quarters = 0; quarters < 4; ++quarters) {
    if (options.start && clockwise(*options.start) != quarters) continue;
    RegistrationOptions own = options;
    own.watch = options.watch.part(0.25 * quarters, 0.25 * (quarters + 1));
    PlacedImage lit = lit_view(afm.eroded(), *model.model, quarters, sem.pitch_x_nm, threads);
    Registration found = register_images(sem, lit, own);
    const double own_rank = rank(found, quarters);
    if (pose.registration && own_rank <= best) continue;
    best = own_rank;
    pose.registration = std::move(found);
    pose.simulated = std::move(lit);
  }
}

Pose pose_of(const PoseOptions& o, const PreparedAfm& afm, const PlacedImage& sem,
             const StoredModel& model, int threads, const Reporter& reporter) {
  begin(reporter, "registration");
  Pose pose;
  if (o.transform) {
    pose.sem_to_afm = *o.transform;
    pose.simulated =
        lit_view(afm.eroded(), *model.model, model.sided ? clockwise(pose.sem_to_afm) : 0,
                 sem.pitch_x_nm, threads);
    return pose;
  }
  pose.simulated = simulated_view(afm.eroded(), *model.model, sem.pitch_x_nm, threads);
  RegistrationOptions options = o.registration;
  if (!o.landmarks.empty()) {
    pose.landmarks = fit_landmarks(o.landmarks);
    pose.sem_to_afm = pose.landmarks->sem_to_afm;
    options.start = pose.sem_to_afm;
    reporter.note(fmt::format("landmarks: {} pairs fit to {} rms", o.landmarks.size(),
                              format_length(pose.landmarks->rms_nm)));
    if (o.landmarks_only) return pose;
  }
  options.threads = threads;
  options.watch = reporter.watch();
  if (model.sided) register_lit(afm, sem, model, options, threads, pose);
  else pose.registration = register_images(sem, pose.simulated, options);
  pose.sem_to_afm = pose.registration->sem_to_afm;
  return pose;
}

const char* name(RegistrationVerdict verdict) {
  switch (verdict) {
    case RegistrationVerdict::verified:
      return "verified";
    case RegistrationVerdict::ambiguous:
      return "ambiguous";
    case RegistrationVerdict::unconverged:
      return "unconverged";
    case RegistrationVerdict::unrelated:
      break;
  }
  return "unrelated";
}

}  // namespace surf::workflow
