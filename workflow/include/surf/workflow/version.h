// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace surf::workflow {

/// semsurf's own version, as "0.1.0".
std::string version();

/// Names and versions of the libraries at work in this program, separated by ", ".
std::string library_versions();

}  // namespace surf::workflow
