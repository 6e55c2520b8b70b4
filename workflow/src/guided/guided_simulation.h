// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "guided/scene_guides.h"
#include "surf/mc/scheduling/unit_journal.h"
#include "surf/mc/simulate.h"
#include "surf/workflow/reporter.h"
#include "surf/workflow/simulate_job.h"
#include "surf/workflow/team.h"

namespace surf::workflow {

/// Settles whether an image is guided: `automatic` is where that pays, which it does not for few
/// pixels, nor for very few or very many electrons. Throws UsageError for what cannot be guided.
void settle_estimate(EstimateOptions& estimate, const mc::SimulationOptions& options,
                     const mc::Scan& scan);

/// The options of guided simulations: counts in halves, and libraries whose own share of the error
/// is small beside what is asked for.
/// `cascades_that_fit`: into memory.
mc::SimulationOptions guided_options(mc::SimulationOptions options, double cascades_that_fit);

/// What a guided simulation is expected to take: an accuracy as a number of electrons, and
/// libraries as large as they will be. Sets how many cascades fit into memory.
mc::SimulationOptions expected_options(const mc::Scene& scene, const mc::SimulationOptions& options,
                                       double& cascades_that_fit);

struct GuidedSimulation {
  mc::SimulationResult result;
  std::vector<GuidedImage> images;  ///< per detector; only of whoever leads
  int rounds = 1;
};

/// Simulates and estimates. With an accuracy it does so round by round: each adds electrons where
/// the estimated error is still too large, until it is not. All members of a team take part; the
/// leader decides.
GuidedSimulation simulate_guided(const mc::Scene& scene, const mc::SimulationOptions& options,
                                 const SceneGuides& guides, double cascades_that_fit,
                                 const mc::SimulationContext& context, const Simulator& simulator,
                                 const Reporter& reporter, Team* team);

/// The number of electrons per pixel that fits into `seconds`, from a first round that is thrown
/// away: at least that round's. The leader finds it for all members of a team.
std::int64_t electrons_that_fit(const mc::Scene& scene, const mc::SimulationOptions& options,
                                const SceneGuides& guides, double cascades_that_fit,
                                const mc::SimulationContext& context, const Simulator& simulator,
                                double seconds, Team* team);

/// Fills in how well an accuracy was met.
void summarize_accuracy(const std::vector<GuidedImage>& images, const mc::Budget& budget,
                        mc::ResultSummary& summary);

}  // namespace surf::workflow
