// SPDX-License-Identifier: GPL-3.0-or-later
#include "common_parameters.h"
#include "surf/core/parameters.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {

void describe(ParameterVisitor& visit, EstimateOptions& options) {
  visit(options.kind, {"plain", "guided", "auto"},
        {.name = "simulation.estimate",
         .help = "A pixel's value from its own electrons alone (plain), or with the help of those "
                 "around it (guided): far fewer electrons for the same error; auto: guided where "
                 "that pays",
         .otherwise = "plain"});
  visit(options.model, {.name = "simulation.guide_model",
                        .help = "Fast model that guides: a file, auto for one of the cache that "
                                "fits, which is trained where "
                                "that pays, or off",
                        .otherwise = "auto",
                        .form = "FILE|auto|off",
                        .level = Level::advanced,
                        .file = FileRole::read});
}

void describe(ParameterVisitor& visit, Extras& extras) {
  visit(extras.channels, {.name = "output.channels",
                          .help = "More channels. What the beam sees: z_nm, normal, material; how "
                                  "it was simulated: electrons, model, variance_left, counts; of "
                                  "guided images: radius, plain",
                          .level = Level::advanced});
  const auto number = [&](int& count, const Parameter& about) {
    std::optional<int> given = count > 0 ? std::optional(count) : std::nullopt;
    visit(given, about);
    count = given.value_or(0);
  };
  number(extras.deposit_cells, {.name = "output.deposit",
                                .help = "Deposited energy on a grid of this many cells along its "
                                        "longest side, in NAME.deposit.vti",
                                .limits = within(1, 1024),
                                .level = Level::advanced});
  number(
      extras.trajectories,
      {.name = "output.trajectories",
       .help =
           "Tracks of this many primaries, in NAME.tracks.vtp, and a side view, in NAME.tracks.png",
       .limits = within(1, 100'000)});
  describe_point(visit, extras.trajectories_at_nm,
                 {.name = "output.trajectories_at",
                  .help = "Point of the scan plane where the primaries of tracks land",
                  .otherwise = "the middle of the scan",
                  .level = Level::advanced});
}

void describe(ParameterVisitor& visit, CheckpointOptions& checkpoint) {
  visit.form(
      {.name = "job.checkpoint",
       .help = "File that unfinished work is kept in, or off",
       .otherwise = "NAME.XXXXXXXX.checkpoint beside the first output, X standing for the job",
       .form = "FILE|off",
       .level = Level::advanced,
       .recorded = false,
       .file = FileRole::written},
      [&] { return checkpoint.wanted ? checkpoint.file.string() : std::string("off"); },
      [&](std::string_view text, const std::string&) {
        checkpoint.wanted = text != "off";
        if (checkpoint.wanted) checkpoint.file = text;
      });
  visit(checkpoint.seconds,
        {.name = "job.checkpoint_every",
         .help = "Time between writes of unfinished work; the first is after 10s or less",
         .unit = Unit::s,
         .limits = above(0),
         .level = Level::advanced,
         .recorded = false});
  visit(checkpoint.restart, {.name = "job.restart",
                             .help = "Begin anew and ignore unfinished work",
                             .level = Level::advanced,
                             .recorded = false});
}

void describe(ParameterVisitor& visit, SimulateJob& job) {
  describe(visit, static_cast<mc::SimulationRequest&>(job.scene));
  describe(visit, job.estimate);
  describe(visit, job.execution);
  describe_cache(visit, job.cache);
  describe(visit, job.extras);
  visit(job.spectra, {.name = "output.spectra",
                      .help = "Energies and angles per detector, in NAME.spectra.csv",
                      .level = Level::advanced,
                      .recorded = false});
  visit(job.png_channel, {.name = "output.png_channel",
                          .help = "Channel that PNG files show",
                          .otherwise = "SE",
                          .form = "NAME",
                          .level = Level::advanced});
  visit(job.layout, {"auto", "rows", "tiles"},
        {.name = "output.layout",
         .help = "Layout of EXR and TIFF: rows, or tiles with smaller sizes for viewing",
         .otherwise = "auto: tiles above 64 million pixels",
         .level = Level::advanced});
  describe_images(visit, job.outputs, "Image to write: .exr .tif .png .vti .hspy");
  describe(visit, job.checkpoint);
}

}  // namespace surf::workflow
