// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace surf::workflow {

/// Stores a chart's point for the same job started again. `identity` identifies the job.
void keep_point(const std::filesystem::path& path, const std::string& identity,
                const nlohmann::ordered_json& point);

/// Reads a point, if the file exists, is complete and belongs to this job.
std::optional<nlohmann::ordered_json> kept_point(const std::filesystem::path& path,
                                                 const std::string& identity);

/// Reads a JSON file; nothing if it is missing or damaged.
std::optional<nlohmann::ordered_json> read_json(const std::filesystem::path& path);

}  // namespace surf::workflow
