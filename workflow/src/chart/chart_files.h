// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "surf/workflow/chart_job.h"

namespace surf::workflow {

/// Keeps a point for the same job started again. `identity` says of which job it is.
void write_point(const std::filesystem::path& path, const ChartPoint& point,
                 const std::string& identity);

/// The point, if the file is there, whole and of this job.
std::optional<ChartPoint> read_point(const std::filesystem::path& path,
                                     const std::string& identity);

/// A time that was measured, to be remembered. 0 where there is none.
double read_seconds(const std::filesystem::path& path);
void write_seconds(const std::filesystem::path& path, double seconds);

/// chart.csv and chart.json.
std::string csv_text(const ChartSummary& summary);
std::string json_text(const ChartJob& job, const ChartSummary& summary);

}  // namespace surf::workflow
