// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sample_truth.h"
#include "surf/core/affine.h"
#include "surf/core/placed_image.h"
#include "surf/workflow/chain_chart_job.h"
#include "surf/workflow/stored_model.h"

namespace surf::workflow {

/// The input of every method in a chart of the chain.
struct ChainSetting {
  const ChainChartJob& job;  ///< complete: `draws` is set
  SampleTruth sample;
  StoredModel model;
  HeightField eroded;     ///< the scan eroded by the true tip
  PlacedImage simulated;  ///< SEM image predicted from it
};

/// A point that is not computed yet: its name, and a function that fills in the rest. Throws
/// Interrupted.
template <class Point>
struct ChainMethod {
  Point point;
  std::function<void(const ChainSetting&, const Watch&, Point&)> run;
};

std::vector<ChainMethod<RegistrationPoint>> list_registrations(const ChainChartJob& job);
std::vector<ChainMethod<ReconstructionPoint>> list_reconstructions(const ChainChartJob& job);

/// Whether the job asks for a family.
bool wants(const ChainChartJob& job, const std::string& family);

/// Root mean square error, in SEM pixels, of the mapped places of an SEM image's pixels over the
/// overlap. Every third pixel along x and y is used.
double registration_error_px(const Affine& truth, const Affine& found, const PlacedImage& sem,
                             const PlacedImage& simulated);

/// The input of one registration: a part of the SEM image, and an initial guess or landmarks that
/// are off by the given amount.
struct RegistrationDraw {
  PlacedImage sem;
  Affine start;
  std::vector<std::pair<Point2, Point2>> pairs;  ///< four landmarks, SEM and AFM, nm
};
RegistrationDraw draw_registration(const SampleTruth& sample, double offset_px, double offset_deg,
                                   std::uint64_t seed, int number);

}  // namespace surf::workflow
