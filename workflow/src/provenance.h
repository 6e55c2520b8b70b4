// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "resolved_job.h"

namespace surf::workflow {

struct InputHash {
  std::filesystem::path path;
  std::string sha256;
};

std::vector<InputHash> hash_inputs(const std::vector<std::filesystem::path>& inputs);

/// Those of the request that changed the result, with the values that were used, under their keys:
/// "beam.energy_ev". Specimen, scan and detectors are named by themselves.
std::map<std::string, std::string> parameters_of(const ResolvedJob& job);

/// Everything that changes the result, as an image's metadata: nothing here may depend on threads,
/// tiles, hosts, clocks, or on the folders that inputs and outputs are in.
std::map<std::string, std::string> provenance(const ResolvedJob& job, const mc::Scan& scan,
                                              const std::vector<InputHash>& inputs);

/// What was asked of the files: channels, layout, tracks. Work that is gone on with does not depend
/// on it.
std::map<std::string, std::string> output_settings(const ResolvedJob& job);

/// What a finished simulation adds: its balance, libraries, how pixels were simulated, warnings
/// and, when cancelled, that it is partial.
std::map<std::string, std::string> outcome(const SimulateSummary& summary);

}  // namespace surf::workflow
