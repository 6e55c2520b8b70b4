// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "../run_many.h"
#include "compared_pixels.h"
#include "surf/mc/geometry/beam.h"
#include "surf/workflow/chart_job.h"

namespace surf::workflow {

/// What every method of a chart is told.
struct ChartSetting {
  const ChartJob& job;
  mc::Scan scan;
  const Reference* reference = nullptr;  ///< not there while methods are only listed
  std::vector<double> accuracies;        ///< coarsest first
};

/// One point before it is there.
struct ChartMethod {
  std::string id, family, setting;
  bool is_default = false;
  /// Fills in the point's times, primaries, channels and targets. Throws Interrupted.
  std::function<void(const ChartSetting&, const Watch&, ChartPoint&)> run;
  bool needs_images = false;  ///< those of make_images
};

struct ChartMethods {
  std::vector<ChartMethod> methods;
  std::vector<std::string> left_out;  ///< sentences
};

/// By Monte Carlo: direct and replayed electrons, wanted accuracies, simplified specimens.
ChartMethods list_simulations(const ChartSetting& setting);

/// The id of the simulation that reaches an accuracy in this way.
std::string id_of_accuracy(mc::Method method, bool planar_control, double accuracy);

/// By the models that `train` makes, where they hold for the scene.
ChartMethods list_models(const ChartSetting& setting);

/// The images that models learn from, once for all of them. Keeps how long they took: each is
/// simulated by one process, so that a team's times mean the same. Throws Interrupted, on all of a
/// team.
ManyDone make_images(const ChartSetting& setting, const Watch& watch, Team* team);

/// Whether the job asks for a family.
bool wants(const ChartJob& job, const std::string& family);

/// "3" for 0.03, "0.5" for 0.005: a part of an id.
std::string percent_text(double share);

}  // namespace surf::workflow
