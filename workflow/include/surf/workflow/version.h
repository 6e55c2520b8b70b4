// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace surf::workflow {

/// The version of semsurf, as "0.1.0".
std::string version();

/// Names and versions of the libraries in use, separated by ", ".
std::string library_versions();

}  // namespace surf::workflow
