// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace surf::cli {

/// Names of options that `semsurf sweep --vary` takes, without dashes.
std::vector<std::string> names_to_vary();

}  // namespace surf::cli
