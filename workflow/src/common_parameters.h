// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "surf/core/parameters.h"
#include "surf/mc/physics/physics.h"

// Parameters shared by several jobs.
namespace surf::workflow {

/// The parameter job.threads.
void describe_threads(ParameterVisitor& visit, int& threads);

/// The parameter "output", a folder; "result/" is stored as "result".
void describe_folder(ParameterVisitor& visit, std::filesystem::path& folder, const char* help);

/// The parameter "output": image files, one for each time that it is given.
void describe_images(ParameterVisitor& visit, std::vector<std::filesystem::path>& outputs,
                     const char* help);

/// A file or a folder.
void describe_path(ParameterVisitor& visit, std::filesystem::path& path, const Parameter& about);

/// Numbers with commas between them that are read back exactly.
std::string exact_list(const std::vector<double>& values);

/// Numbers that are given one by one, or with commas between them.
void describe_numbers(ParameterVisitor& visit, std::vector<double>& values, const Parameter& about);
/// Names separated by commas: "NAME,NAME".
void describe_names(ParameterVisitor& visit, std::vector<std::string>& names,
                    const Parameter& about);

/// The parameter output.no_picture.
void describe_picture(ParameterVisitor& visit, bool& picture);

/// Energy, spot and physics of simulations that are compared with images.
void describe_beam(ParameterVisitor& visit, double& energy_ev, double& spot_nm,
                   mc::Physics& physics);

/// The parameter job.cache, a folder or "off".
void describe_cache(ParameterVisitor& visit, std::filesystem::path& cache);

/// A point "X,Y" in nm.
void describe_point(ParameterVisitor& visit, std::optional<std::pair<double, double>>& point_nm,
                    Parameter about);

}  // namespace surf::workflow
