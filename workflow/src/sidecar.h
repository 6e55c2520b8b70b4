// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "provenance.h"
#include "resolved_job.h"

namespace surf::workflow {

/// The record of one run: everything that may differ between two runs with the same bytes.
struct RunRecord {
  std::chrono::system_clock::time_point start, end;
  std::vector<InputHash> inputs;
  std::vector<std::filesystem::path> outputs;
};

/// The path `NAME.run.json` beside NAME.exr, NAME.tif ...: files of one run with one name share it.
std::filesystem::path sidecar_path(const std::filesystem::path& output);

/// The record as JSON.
std::string sidecar_text(const ResolvedJob& job, const SimulateSummary& summary,
                         const RunRecord& record);

}  // namespace surf::workflow
