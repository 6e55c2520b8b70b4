// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "surf/workflow/chart_job.h"

namespace surf::workflow {

/// Stores a point for the same job started again. `identity` identifies the job.
void write_point(const std::filesystem::path& path, const ChartPoint& point,
                 const std::string& identity);

/// Reads a point, if the file exists, is complete and belongs to this job.
std::optional<ChartPoint> read_point(const std::filesystem::path& path,
                                     const std::string& identity);

/// A stored measured time; 0 if there is none.
double read_seconds(const std::filesystem::path& path);
void write_seconds(const std::filesystem::path& path, double seconds);

/// The content of chart.csv and chart.json.
std::string csv_text(const ChartSummary& summary);
std::string json_text(const ChartJob& job, const ChartSummary& summary);

}  // namespace surf::workflow
