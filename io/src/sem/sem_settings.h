// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

namespace surf::io {

/// The files beside an SEM image in which its microscope noted its settings.
std::vector<std::filesystem::path> sem_settings_beside(const std::filesystem::path& image);

}  // namespace surf::io
