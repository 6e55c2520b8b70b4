// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "resolved_job.h"
#include "surf/mc/geometry/scene.h"
#include "surf/mc/transport/energy_deposit.h"

namespace surf::workflow {

/// Throws UsageError for unknown channels and numbers out of range.
void check_extras(const Extras& extras);

/// Whether counts are to be kept in halves.
bool wants_counts(const Extras& extras);

/// Throws UsageError for channels that the job's way of estimating does not have.
void check_extras_of(const ResolvedJob& job);

/// The name of one extra file.
std::filesystem::path extra_path(const ResolvedJob& job, const char* extension);

/// The files besides the image that a job writes.
std::vector<std::filesystem::path> extra_files(const ResolvedJob& job);

/// Adds the requested channels besides the detectors'. The metadata get the meaning of the numbers
/// of materials and models. `image` refers to `result` and `guided`.
void add_channels(const mc::Scene& scene, const ResolvedJob& job,
                  const mc::SimulationResult& result, const std::vector<GuidedImage>& guided,
                  ImageRows& image);

/// The names of the added channels whose values are labels.
std::vector<std::string> label_channels();

/// The channels that `add_channels` adds.
std::vector<std::string> extra_channels(const ResolvedJob& job);

/// Spectra as CSV: detector, quantity, unit, from, to, yield, standard_error. Yields are counts per
/// primary in that bin, with the detector's efficiency.
std::string spectra_text(const mc::SimulationResult& result);

/// The deposits of all threads of one simulation.
class Deposits {
 public:
  Deposits(const mc::Scene& scene, int cells, int threads);
  mc::Observer* of_thread(int thread) { return &per_thread_[static_cast<std::size_t>(thread)]; }
  Volume density(std::int64_t primaries) const;

 private:
  mc::DepositGrid grid_;
  std::vector<mc::EnergyDeposit> per_thread_;
};

/// Throws UsageError if tracks are requested at a place outside the scan.
void check_trajectories(const ResolvedJob& job, const mc::Scan& scan);

/// Simulates the requested tracks, separately from the image, and writes them with a picture.
void write_trajectories(const mc::Scene& scene, const ResolvedJob& job,
                        const std::map<std::string, std::string>& settings);

}  // namespace surf::workflow
