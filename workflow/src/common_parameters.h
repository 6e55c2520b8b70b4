// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "surf/core/parameters.h"

// Parameters that several jobs have.
namespace surf::workflow {

/// job.threads.
void describe_threads(ParameterVisitor& visit, int& threads);

/// "output", a folder; "result/" is "result".
void describe_folder(ParameterVisitor& visit, std::filesystem::path& folder, const char* help);

/// A file or a folder.
void describe_path(ParameterVisitor& visit, std::filesystem::path& path, const Parameter& about);

/// "NAME,NAME".
void describe_names(ParameterVisitor& visit, std::vector<std::string>& names,
                    const Parameter& about);

/// job.cache, a folder or "off".
void describe_cache(ParameterVisitor& visit, std::filesystem::path& cache);

/// "X,Y" in nm.
void describe_point(ParameterVisitor& visit, std::optional<std::pair<double, double>>& point_nm,
                    Parameter about);

}  // namespace surf::workflow
