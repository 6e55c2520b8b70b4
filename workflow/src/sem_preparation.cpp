// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem_preparation.h"

#include <fmt/format.h>

#include <cmath>

#include "chain_steps.h"
#include "surf/core/units.h"
#include "surf/reconstruction/tilt_by_sem.h"

namespace surf::workflow {
namespace {

constexpr int coarse_iterations = 12;

/// Tilts the scan about the middle of the SEM image.
void tilt_scan(const SemTilt& by, const PlacedImage& sem, const Affine& map, PreparedAfm& prepared,
               AfmData& afm) {
  const Point2 middle =
      map(sem.place_nm(0.5 * (sem.values.width() - 1), 0.5 * (sem.values.height() - 1)));
  const Plane back{0, -by.x, -by.y, middle.x, middle.y};
  subtract(prepared.image, back);
  subtract(prepared.certainty.surface, back);
  prepared.level_doubt = by.doubt;
  afm.image = prepared.image;
  afm.level_doubt = by.doubt;
}

/// Levels the scan by the SEM image, too: `found` is what it has been tilted by so far. Where the
/// image asks for more than the scan's plane can be off by, as one of a detector at the side does,
/// the scan stays as it was levelled, and the answer is false.
bool level_by_sem(const HeightField& surface, const SemData& sem, const Affine& map,
                  const SlopeDoubt& doubt, int threads, PreparedAfm& prepared, AfmData& afm,
                  SemTilt& found, const Reporter& told) {
  constexpr double most_deviations = 4;
  const SemTilt more = tilt_by_sem(surface, sem, map, {-found.x, -found.y, doubt}, threads);
  const SemTilt all{found.x + more.x, found.y + more.y, more.doubt};
  const double deviations = std::hypot(all.x / doubt.x, all.y / doubt.y);
  if (deviations <= most_deviations) {
    found = all;
    tilt_scan(more, sem.image, sem.sem_to_afm, prepared, afm);
    return true;
  }
  tilt_scan({-found.x, -found.y, doubt}, sem.image, sem.sem_to_afm, prepared, afm);
  found = {0, 0, doubt};
  told.warn(fmt::format(
      "the SEM image asks for a scan that is tilted by {:.2f} deg, {:.0f} standard errors more "
      "than "
      "its plane is off by: the scan stays as it was levelled. A detector at one side makes such "
      "images, and a model without sides does not explain them",
      std::atan(std::hypot(all.x, all.y)) / degrees_to_radians, deviations));
  return false;
}

}  // namespace

ReconstructionOptions coarse_options(const ReconstructJob& job, const ReconstructSummary& s,
                                     bool gains_tied) {
  const Grid<double>& image = job.sem->image.values;
  ReconstructionOptions coarse;
  coarse.scales_px = {default_scales_px(coarse.method, image.width(), image.height()).front()};
  coarse.iterations = coarse_iterations;
  coarse.refine_calibration = !gains_tied && !job.calibration;
  coarse.refine_transform = job.options.refine_transform;
  coarse.refine_tip = options_of(job, s).refine_tip;
  coarse.curvature_prior_per_nm = job.options.curvature_prior_per_nm;
  coarse.uncertainty = false;
  coarse.rough_ground = s.afm && s.afm->rough_ground;
  coarse.threads = job.options.threads;
  return coarse;
}

SemData sem_at(const ReconstructJob& job, const ReconstructSummary& s, const PlacedImage& image,
               const Affine& map, const FirstCalibration& calibration) {
  SemData sem{image,
              s.model->model,
              calibration.gains,
              calibration.offset,
              calibration.noise,
              map,
              usual_discrepancy(image, job.model_error)};
  // On rough ground slopes are the surface itself, and an error that follows them hides it.
  if (!(s.afm && s.afm->rough_ground)) sem.guided_deviation = job.model_error * contrast_of(image);
  if (job.line_jitter_px > 0) sem.row_jitter = line_jitter(image, job.line_jitter_px);
  return sem;
}

SemData prepare_sem(const ReconstructJob& job, ReconstructSummary& s, const PlacedImage& image,
                    AfmData* afm, const Reporter& told) {
  begin(told, "calibration");
  const SlopeDoubt level_doubt = afm ? afm->level_doubt : SlopeDoubt{};
  bool levels = afm && !job.tilt && level_doubt.x > 0 && level_doubt.y > 0;
  constexpr int rounds = 2;
  const HeightField* eroded = s.afm ? &s.afm->eroded() : nullptr;
  const Affine map = s.pose ? s.pose->sem_to_afm : Affine{};
  const int threads = job.options.threads;
  FirstCalibration first =
      calibrate_first(image, eroded, *s.model->model, map, job.calibration, job.sem_noise, threads);
  const auto data = [&] { return sem_at(job, s, image, map, first); };
  const bool calibrates = !(job.calibration && job.sem_noise);
  if (afm && job.tilt) s.tilt = *job.tilt, tilt_scan(s.tilt, image, map, *s.afm, *afm);
  for (int round = 0; afm && (calibrates || levels) && round < rounds; ++round) {
    ReconstructionOptions coarse = coarse_options(job, s, first.tied);
    coarse.watch = told.watch().part(double(round) / rounds, double(round + 1) / rounds);
    const SemData sem = data();
    const Reconstruction r = reconstruct(afm, &sem, coarse);
    if (levels)
      levels = level_by_sem(r.surface, sem, r.sem_to_afm, level_doubt, threads, *s.afm, *afm,
                            s.tilt, told);
    if (!calibrate_again(image, r.surface, *s.model->model, job.calibration.has_value(),
                         job.sem_noise.has_value(), threads, first))
      break;
  }
  if (levels)
    told.note(fmt::format("AFM: levelled by the SEM image, too, which tilts it by {:.3f} deg",
                          std::atan(std::hypot(s.tilt.x, s.tilt.y)) / degrees_to_radians));
  for (const std::string& warning : first.warnings) told.warn(warning);
  if (first.tied)
    told.warn(
        "the channels of the model cannot be told apart in the SEM image, so all have one gain; "
        "say `reconstruction.gains` if you "
        "know them");
  s.gains_tied = first.tied;
  s.calibration = first.fit;
  s.sem_noise = first.noise;
  s.sem_noise_from = first.noise_from;
  return data();
}

}  // namespace surf::workflow
