// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

namespace surf::cli {

/// `semsurf noise sem`: the noise of one SEM image.
struct SemNoiseInput {
  std::optional<std::string> image, pixel_size, block, black, white;
  std::vector<std::string> regions;
};

/// All but the image and its pixel size. A `group` of "" hides them.
void add_sem_noise_options(CLI::App& app, SemNoiseInput& input, const std::string& group);

/// Throws UsageError if one of them is given without an image.
void require_sem(const SemNoiseInput& input);

int print_sem_noise(const SemNoiseInput& input, const std::optional<std::string>& plot, bool quiet);

}  // namespace surf::cli
