// SPDX-License-Identifier: GPL-3.0-or-later
#include "common_parameters.h"
#include "surf/workflow/compare_job.h"

namespace surf::workflow {

void describe(ParameterVisitor& visit, CompareParameters& p) {
  visit(p.registered,
        {.name = "compare.registered",
         .help = "Take the positions that both files state, without searching for a shift"});
  visit(p.largest_shift_nm, {.name = "compare.largest_shift",
                             .help = "Largest shift along x and y that is searched for",
                             .unit = Unit::nm,
                             .limits = at_least(0),
                             .otherwise = "as far as enough overlaps"});
  visit(p.least_overlap,
        {.name = "compare.least_overlap",
         .help = "Least share of the smaller surface that must overlap with the other",
         .unit = Unit::share,
         .limits = above(0, 1),
         .level = Level::advanced});
  visit(p.before_deviation_nm, {.name = "compare.before_deviation",
                                .help = "Standard deviation of the errors of heights before",
                                .unit = Unit::nm,
                                .limits = at_least(0),
                                .otherwise = "as the file says, else from the difference"});
  visit(p.after_deviation_nm, {.name = "compare.after_deviation",
                               .help = "Standard deviation of the errors of heights after",
                               .unit = Unit::nm,
                               .limits = at_least(0),
                               .otherwise = "as the file says, else from the difference"});
  visit(p.false_alarms, {.name = "compare.false_alarms",
                         .help = "Probability that anything is reported where nothing changed",
                         .unit = Unit::share,
                         .limits = within(0.001, 0.5)});
  visit(p.largest_nm, {.name = "compare.largest_window",
                       .help = "Side of the largest window that is searched for changes",
                       .unit = Unit::nm,
                       .limits = above(0),
                       .otherwise = "a quarter of the view, at most 64 samples"});
  visit(p.smallest_px, {.name = "compare.smallest_window",
                        .help = "Side of the smallest window, in samples",
                        .limits = within(1, 1000),
                        .form = "SAMPLES",
                        .level = Level::advanced});
  visit(p.simulations, {.name = "compare.simulations",
                        .help = "Number of simulated noise fields; 0: 20 divided by the rate of "
                                "false alarms, at least 400",
                        .limits = within(0, 1'000'000),
                        .level = Level::advanced});
  visit(p.model_error,
        {.name = "compare.model_error",
         .help = "Expected error of a predicted SEM image, as a share of its contrast",
         .unit = Unit::share,
         .limits = within(0, 1)});
  visit(p.seed,
        {.name = "compare.seed", .help = "Seed of the simulated noise", .level = Level::advanced});
}

void describe(ParameterVisitor& visit, CompareJob& job) {
  describe(visit, job.parameters);
  describe(visit, job.model);
  describe_threads(visit, job.threads);
  describe_picture(visit, job.picture);
  describe_folder(visit, job.folder, "Folder for results, created if it is missing");
}

}  // namespace surf::workflow
