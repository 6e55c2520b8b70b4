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

/// The input of every method in a chart.
struct ChartSetting {
  const ChartJob& job;
  mc::Scan scan;
  const Reference* reference = nullptr;  ///< null while methods are only listed
  std::vector<double> accuracies;        ///< coarsest first
};

/// A point that is not computed yet.
struct ChartMethod {
  std::string id, family, setting;
  bool is_default = false;
  /// Fills in the point's times, primaries, channels and targets. Throws Interrupted.
  std::function<void(const ChartSetting&, const Watch&, ChartPoint&)> run;
  bool needs_images = false;  ///< it needs the images of make_images
};

struct ChartMethods {
  std::vector<ChartMethod> methods;
  std::vector<std::string> left_out;  ///< in sentences
};

/// Methods by Monte Carlo: direct and replayed electrons, wanted accuracies, simplified specimens.
ChartMethods list_simulations(const ChartSetting& setting);

/// The id of the simulation that reaches an accuracy in this way.
std::string id_of_accuracy(mc::Method method, bool planar_control, double accuracy);

/// Methods by the models that `train` makes, if they apply to the scene.
ChartMethods list_models(const ChartSetting& setting);

/// Makes the training images, once for all models. Stores the time that they took: one process
/// simulates each, so that a team's times mean the same. Throws Interrupted, on all members of a
/// team.
ManyDone make_images(const ChartSetting& setting, const Watch& watch, Team* team);

/// Whether the job asks for a family.
bool wants(const ChartJob& job, const std::string& family);

/// "3" for 0.03, "0.5" for 0.005: a part of an id.
std::string percent_text(double share);

}  // namespace surf::workflow
