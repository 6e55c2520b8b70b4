// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace surf::workflow {

/// Keeps a chart's point for the same job started again. `identity` says of which job it is.
void keep_point(const std::filesystem::path& path, const std::string& identity,
                const nlohmann::ordered_json& point);

/// The point, if the file is there, whole and of this job.
std::optional<nlohmann::ordered_json> kept_point(const std::filesystem::path& path,
                                                 const std::string& identity);

/// What a file holds; nothing where there is none or it is damaged.
std::optional<nlohmann::ordered_json> read_json(const std::filesystem::path& path);

}  // namespace surf::workflow
