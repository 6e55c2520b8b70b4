// SPDX-License-Identifier: GPL-3.0-or-later
#include "common_parameters.h"
#include "surf/core/some_parameters.h"
#include "surf/reconstruction/view.h"
#include "surf/workflow/refine_job.h"
#include "surf/workflow/view_settings.h"

namespace surf::workflow {
namespace {

/// A length that is chosen where it is not said.
void describe_chosen(ParameterVisitor& visit, double& length_nm, Parameter about) {
  std::optional<double> said = length_nm > 0 ? std::optional(length_nm) : std::nullopt;
  about.unit = Unit::nm;
  about.limits = within(0.1, 10'000);
  visit(said, about);
  length_nm = said.value_or(0);
}

}  // namespace

void describe(ParameterVisitor& visit, RefineJob& job) {
  if (job.images.empty()) job.images.resize(1);
  describe(visit, job.images.front());
  describe_beam(visit, job.energy_ev, job.spot_nm, job.physics);
  ViewSettings views{job.tilts_deg, job.azimuths_deg, {}, job.signals, job.tilt_error_deg};
  describe_some(
      visit, views,
      {{.name = "beam.tilt",
        .help = "Angle of the beam from straight down in each SEM image in turn, or in all"},
       {.name = "beam.azimuth",
        .help =
            "Direction in which the tilted beam travels in each SEM image: 0 is +x, 90deg is +y"},
       {.name = "reconstruction.view_signal",
        .help = "Signal of each SEM image, separated by semicolons: SE, BSE, a quadrant or a "
                "detector as for 'semsurf simulate --detector'",
        .otherwise = "SE"},
       {.name = "reconstruction.tilt_error"}});
  if (visit.reads()) {
    job.tilts_deg = views.tilts_deg, job.azimuths_deg = views.azimuths_deg;
    job.signals = views.signals, job.tilt_error_deg = views.tilt_error_deg;
  }
  visit(job.substrate_z_nm,
        {.name = "refinement.substrate",
         .help = "Height of a substrate of the same material, which fills everything below it",
         .unit = Unit::nm,
         .limits = within(-1e6, 1e6),
         .otherwise = "there is none"});
  visit(job.start_error_nm, {.name = "refinement.start_error",
                             .help = "Expected error of the start's shape as a whole: sizes, "
                                     "places, angles of walls; a standard deviation",
                             .unit = Unit::nm,
                             .limits = within(0.01, 10'000)});
  visit(job.height_error_nm,
        {.name = "refinement.height_error",
         .help = "Expected error of the start's heights, a standard deviation: small where an AFM "
                 "scan gave them, as images from above hardly show heights",
         .unit = Unit::nm,
         .limits = within(0.01, 10'000)});
  visit(job.bump_error_nm,
        {.name = "refinement.bump_error",
         .help = "Local error of the start besides its error as a whole, a standard deviation",
         .unit = Unit::nm,
         .limits = within(0.01, 10'000)});
  visit(job.bump_length_nm, {.name = "refinement.bump_length",
                             .help = "Correlation length of the local error",
                             .unit = Unit::nm,
                             .limits = within(0.1, 100'000)});
  describe_chosen(visit, job.edge_nm,
                  {.name = "refinement.edge",
                   .help = "Length of triangle edges where the images show the mesh",
                   .otherwise = "two pixels"});
  describe_chosen(visit, job.spacing_nm,
                  {.name = "refinement.spacing",
                   .help = "Distance between the bumps that are fitted",
                   .otherwise = "three edges"});
  visit(job.smooth_rounds, {.name = "refinement.smooth_rounds",
                            .help = "Steps that fit the shape as a whole",
                            .limits = within(1, 20)});
  visit(job.bump_rounds,
        {.name = "refinement.bump_rounds",
         .help = "Steps that fit local bumps, after those of the whole shape; 0: none",
         .limits = within(0, 20)});
  visit(job.electrons, {.name = "refinement.electrons",
                        .help = "Primaries per pixel of simulated images",
                        .limits = within(2, 1'000'000)});
  visit(job.effect_electrons,
        {.name = "refinement.effect_electrons",
         .help = "Primaries per pixel of the images that measure the effect of a change",
         .limits = within(2, 1'000'000)});
  visit(job.model_error, {.name = "refinement.model_error",
                          .help = "Expected error of simulated images, as a share of the contrast, "
                                  "because of other physics or another detector",
                          .unit = Unit::share,
                          .limits = within(0, 1)});
  visit(job.seed, {.name = "refinement.seed", .help = "Seed of the simulations"});
  describe_cache(visit, job.cache);
  describe_threads(visit, job.threads);
  describe_picture(visit, job.picture);
  describe_folder(visit, job.folder, "Folder for results, created if it is missing");
}

}  // namespace surf::workflow
