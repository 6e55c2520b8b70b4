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

/// What every method of a chart of the chain is told.
struct ChainSetting {
  const ChainChartJob& job;  ///< complete: `draws` is there
  SampleTruth sample;
  StoredModel model;
  HeightField eroded;     ///< the scan with the true tip taken off
  PlacedImage simulated;  ///< the SEM image predicted of it
};

/// One point before it is there: what names it, and how the rest is found. Throws Interrupted.
template <class Point>
struct ChainMethod {
  Point point;
  std::function<void(const ChainSetting&, const Watch&, Point&)> run;
};

std::vector<ChainMethod<RegistrationPoint>> list_registrations(const ChainChartJob& job);
std::vector<ChainMethod<ReconstructionPoint>> list_reconstructions(const ChainChartJob& job);

/// Whether the job asks for a family.
bool wants(const ChainChartJob& job, const std::string& family);

/// Root mean square over the overlap of where the pixels of an SEM image are put less where they
/// belong, SEM pixels. Every third along x and y is looked at.
double registration_error_px(const Affine& truth, const Affine& found, const PlacedImage& sem,
                             const PlacedImage& simulated);

/// What a part of the image registers like that is begun off.
struct RegistrationDraw {
  PlacedImage sem;
  Affine start;
  std::vector<std::pair<Point2, Point2>> pairs;  ///< four landmarks, SEM and AFM, nm
};
RegistrationDraw draw_registration(const SampleTruth& sample, double offset_px, double offset_deg,
                                   std::uint64_t seed, int number);

}  // namespace surf::workflow
