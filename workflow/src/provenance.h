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

/// The parameters of the request that affected the result, with the values used, under their keys:
/// "beam.energy_ev". Specimen, scan and detectors are described elsewhere.
std::map<std::string, std::string> parameters_of(const ResolvedJob& job);

/// Everything that affects the result, as an image's metadata. Nothing here may depend on threads,
/// tiles, hosts, clocks, or the folders of inputs and outputs.
std::map<std::string, std::string> provenance(const ResolvedJob& job, const mc::Scan& scan,
                                              const std::vector<InputHash>& inputs);

/// The settings of the output files: channels, layout, tracks. A continued job may change them.
std::map<std::string, std::string> output_settings(const ResolvedJob& job);

/// The metadata added by a finished simulation: its balance, libraries, how pixels were simulated,
/// warnings and, if cancelled, that it is partial.
std::map<std::string, std::string> outcome(const SimulateSummary& summary);

}  // namespace surf::workflow
