// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/image.h"
#include "surf/core/progress.h"
#include "surf/workflow/simulate_job.h"

class vtkAlgorithm;
class vtkMultiProcessController;

namespace surf::pv {

/// The job in memory, from beginning to end, with its warnings as ParaView's. With the ranks of
/// `ranks` (or nullptr) each simulates a share of the units of work and is sent those of the
/// others, so that all have the whole result: the bytes that one rank makes. Called on ParaView's
/// thread, on all ranks alike.
workflow::SimulateSummary simulate(vtkAlgorithm* self, const workflow::SimulateJob& job,
                                   vtkMultiProcessController* ranks);

/// The same simulation in a thread of its own, to be looked at on the way: first a few electrons in
/// ever more places, then what is done of the image, in the end the very result of `simulate`.
class LiveSimulation {
 public:
  /// `scan` is the job's.
  LiveSimulation(workflow::SimulateJob job, const mc::Scan& scan);
  ~LiveSimulation();  ///< ends it
  LiveSimulation(const LiveSimulation&) = delete;
  LiveSimulation& operator=(const LiveSimulation&) = delete;

  bool has_news() const;  ///< since the last look
  bool ended() const;
  /// For news, at most so long; the first time for the end of the coarse images, or longer if there
  /// is nothing else.
  void wait(double seconds, const CancelToken& cancel) const;

  struct View {
    Image image;
    mc::SimulationResult result;  ///< so far
    std::vector<Track> tracks;
    Record record;                      ///< what the image says of how it was made
    std::vector<std::string> warnings;  ///< that have come since the last look
    const char* state = "";             ///< "coarse", "refining" or "done"
  };
  /// Throws what ended the simulation. With nothing to show yet the image is 0 and not valid.
  View look();

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace surf::pv
