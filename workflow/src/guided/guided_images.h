// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "guided/scene_guides.h"
#include "surf/core/image_rows.h"
#include "surf/mc/results/simulation_result.h"
#include "surf/sem/guided_estimate.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {

/// What is known of the primaries of one pixel: those of odd number are the second half.
struct PixelCounts {
  std::int64_t primaries = 0;
  mc::Counts all, odd;
};
CountImage in_halves(int width, int height,
                     const std::function<PixelCounts(int x, int y)>& counts_at);

/// Estimates the image of each of several detectors of the same primaries. Detectors that guide the
/// others are estimated without each other first.
std::vector<GuidedImage> estimate_detectors(
    const std::vector<std::string>& detectors,
    const std::function<CountImage(std::size_t detector)>& counts_of, const SceneGuides& guides,
    const GuidedOptions& options);

/// Estimates each detector's image from a result with `odd_counts`. Values are before the
/// detector's efficiency.
std::vector<GuidedImage> estimate_images(const mc::SimulationResult& result,
                                         const SceneGuides& guides, int threads,
                                         const Watch& watch);

/// What guides have brought one detector, whose plain standard errors are given before its
/// efficiency. Yields below a twentieth of the mean count as that much.
GuidedGain gain_of(const GuidedImage& image, const Grid<double>& plain_error);
std::vector<GuidedGain> gains_of(const mc::SimulationResult& result,
                                 const std::vector<GuidedImage>& images);

/// Puts estimates in place of the channels NAME and NAME.stderr of an image made of `result`.
/// Pixels that were not estimated, such as those that the middle of the beam misses, keep their
/// plain values. `images` and `result` must outlive the image.
void show_guided(const mc::SimulationResult& result, const std::vector<GuidedImage>& images,
                 ImageRows& image);

}  // namespace surf::workflow
