// SPDX-License-Identifier: GPL-3.0-or-later
#include "check_inputs.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "surf/core/error.h"

namespace surf::reconstruction {
namespace {

void check_discrepancy(const SemData& sem) {
  double before_px = 1;
  for (const SemDiscrepancy& part : sem.discrepancy) {
    if (part.deviation.width() != sem.image.values.width() ||
        part.deviation.height() != sem.image.values.height())
      throw InvalidInput("SEM discrepancy", "it has another size than the SEM image",
                         "Give a deviation for each pixel");
    if (!std::ranges::all_of(part.deviation.data(),
                             [](double d) { return d >= 0 && std::isfinite(d); }))
      throw InvalidInput("SEM discrepancy", "a deviation is negative or not finite",
                         "Give 0 where the model is right");
    if (!(part.correlation_px >= before_px && part.correlation_px <= 1000))
      throw InvalidInput("SEM discrepancy",
                         fmt::format("a correlation length is {} pixels", part.correlation_px),
                         "Give lengths from 1 to 1000 that do not fall");
    before_px = part.correlation_px;
  }
  const Grid<double>& jitter = sem.row_jitter;
  if (!jitter.empty() &&
      (jitter.width() != sem.image.values.width() || jitter.height() != sem.image.values.height() ||
       !std::ranges::all_of(jitter.data(), [](double v) { return std::isfinite(v); })))
    throw InvalidInput("SEM image", "the jitter of its rows is not finite, or has another size",
                       "Give a value for each pixel");
}

/// What an image's likelihood needs, whatever it is of.
void check_image(const SemData& sem, const char* name) {
  validate(sem.image, name);
  validate(sem.noise);
  if (!sem.model) throw InvalidInput(name, "there is no model of it", "Train or load one");
  if (sem.gains.size() != sem.model->channels().size())
    throw InvalidInput(name, "there is not one gain for each channel of the model",
                       "Calibrate the model");
  if (std::fabs(sem.image.pitch_x_nm / sem.image.pitch_y_nm - 1) > 1e-3)
    throw InvalidInput(name, "its pixels are not square", "Resample it");
  const double scene = sem.model->scope().pixel_nm;
  if (scene > 0 && std::fabs(scene / sem.image.pitch_x_nm - 1) > 1e-3)
    throw InvalidInput(
        name,
        fmt::format("its pixels are {} nm wide, the model's {} nm", sem.image.pitch_x_nm, scene),
        "Train a model for this pixel size");
  check_discrepancy(sem);
}

void check_views(const SemData* sem, const std::vector<SemView>& views,
                 const ReconstructionOptions& o) {
  if (views.empty()) return;
  if (!sem)
    throw InvalidInput("views", "there is no first SEM image, which is looked at from above",
                       "Give one");
  if (o.method != ReconstructionMethod::gauss_newton)
    throw UsageError("`reconstruction.optimiser`", "only Gauss-Newton knows more than one view",
                     "Leave it out");
  for (const SemView& v : views) {
    check_image(v.sem, "view");
    if (!(v.pose.tilt_deg >= 0 && v.pose.tilt_deg <= largest_view_tilt_deg) ||
        !std::isfinite(v.pose.azimuth_deg))
      throw InvalidInput("view", fmt::format("its tilt is {} degrees", v.pose.tilt_deg),
                         fmt::format("Give 0 to {:g}", largest_view_tilt_deg));
    if (!(v.tilt_error_deg > 0 && v.scale_error > 0))
      throw InvalidInput("view", "a standard error of its pose is not above 0",
                         "Give a small one where the pose is known");
    inverse(v.pose.to_plane);
  }
}

}  // namespace

void check_inputs(const AfmData* afm, const SemData* sem, const std::vector<SemView>& views,
                  const ReconstructionOptions& o) {
  if (!afm && !sem)
    throw InvalidInput("reconstruct", "neither an AFM nor an SEM image is given",
                       "Give one or both");
  if (afm) {
    validate(afm->image, "AFM image");
    validate(afm->tip, "tip");
    validate(afm->noise, "AFM noise");
    if (afm->upsample < 1 || afm->upsample > 8)
      throw UsageError("upsample", fmt::format("{} is not in 1 to 8", afm->upsample), "3 is usual");
  }
  if (sem) {
    check_image(*sem, "SEM image");
    inverse(sem->sem_to_afm);
  }
  for (std::size_t i = 0; i < o.scales_px.size(); ++i)
    if (!(o.scales_px[i] > 0.2 && o.scales_px[i] <= 1000) ||
        (i > 0 && o.scales_px[i] >= o.scales_px[i - 1]))
      throw UsageError("scales", "scales must fall, from at most 1000 to more than 0.2 pixels",
                       "As 16,8,4,2,1");
  if (o.iterations < 0 || o.tolerance < 0 || o.curvature_prior_per_nm < 0 || o.probes < 2)
    throw UsageError("reconstruct", "an option is out of range", "See the help for ranges");
  check_views(sem, views, o);
}

}  // namespace surf::reconstruction
