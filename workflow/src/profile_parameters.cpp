// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/ranges.h>

#include "common_parameters.h"
#include "surf/core/some_parameters.h"
#include "surf/workflow/profile_job.h"

namespace surf::workflow {
void describe(ParameterVisitor& visit, ProfileJob& job) {
  describe(visit, job.sem);
  visit(job.kind, {"line", "trench", "edge", "hole"},
        {.name = "profile.kind", .help = "Feature to measure; an edge has the ground on its left"});
  visit(job.along_x, {.name = "profile.along_x", .help = "Lines run along x, not along y"});
  std::optional<double> height = job.height_nm > 0 ? std::optional(job.height_nm) : std::nullopt;
  visit(
      height,
      {.name = "profile.height",
       .help =
           "Height of the walls, which no upright view shows; a first guess where views are tilted",
       .unit = Unit::nm,
       .limits = within(1, 100'000),
       .otherwise = "as the scan shows"});
  job.height_nm = height.value_or(0);
  visit(job.height_error_nm, {.name = "profile.height_error",
                              .help = "Standard error of the height",
                              .unit = Unit::nm,
                              .limits = within(0, 10'000)});
  visit(job.pitch_nm, {.name = "profile.pitch",
                       .help = "Pitch of lines or trenches; 0nm: there is only one",
                       .unit = Unit::nm,
                       .limits = within(0, 1e6),
                       .otherwise = "as the image shows"});
  visit(job.angle_deg, {.name = "profile.angle",
                        .help = "Angle of walls about which profiles are simulated; above 90deg "
                                "they are undercut",
                        .unit = Unit::deg,
                        .limits = within(45, 120)});
  visit(job.angle_range_deg,
        {.name = "profile.angle_range",
         .help = "Range of wall angles that are simulated, on each side of the expected one",
         .unit = Unit::deg,
         .limits = within(0.5, 20)});
  visit(job.top_radius_nm,
        {.name = "profile.top_radius",
         .help = "Usual radius of the upper corners; the fit expects it to be off by about as much",
         .unit = Unit::nm,
         .limits = within(0, 1000)});
  visit(job.foot_radius_nm,
        {.name = "profile.foot_radius",
         .help = "Usual radius of the lower corners; the fit expects it to be off by about as much",
         .unit = Unit::nm,
         .limits = within(0, 1000)});
  visit(job.walls_apart, {.name = "profile.walls_apart",
                          .help = "Fit left and right walls with shapes of their own"});
  visit(job.threshold, {.name = "profile.threshold",
                        .help = "Threshold of the threshold method, a share of the way from the "
                                "ground's level to the rim's",
                        .limits = within(0.05, 0.95)});
  describe_beam(visit, job.energy_ev, job.spot_nm, job.physics);
  visit(job.signal,
        {.name = "profile.signal",
         .help = "Signal of the image: SE, BSE, a quadrant BSE-right, BSE-top, BSE-left, "
                 "BSE-bottom, or a detector as for 'semsurf simulate --detector'",
         .form = "SIGNAL"});
  describe(visit, job.view_settings);
  visit(job.electrons, {.name = "profile.electrons",
                        .help = "Primaries per place of simulated profiles",
                        .limits = within(10, 1'000'000)});
  visit(job.middle_electrons,
        {.name = "profile.middle_electrons",
         .help = "Primaries per place of the middle profile, which tells the level of all",
         .limits = within(10, 100'000'000),
         .level = Level::advanced});
  visit(job.rounds,
        {.name = "profile.rounds",
         .help = "Rounds of simulated profiles, each nearer to the fit than the one before",
         .limits = within(1, 5)});
  visit(job.model_error, {.name = "profile.model_error",
                          .help = "Largest error to expect of simulated profiles, as a share of "
                                  "their contrast, because of other physics or another detector; "
                                  "where the height is known, images show how much there is",
                          .unit = Unit::share,
                          .limits = within(0, 1)});
  visit(job.seed, {.name = "profile.seed", .help = "Seed of the simulations"});
  describe_cache(visit, job.cache);
  describe_threads(visit, job.threads);
  describe_picture(visit, job.picture);
  describe_folder(visit, job.folder, "Folder for results, created if it is missing");
}

}  // namespace surf::workflow
