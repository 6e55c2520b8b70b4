// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace surf::workflow {

/// The version of semsurf, as "0.1.0".
std::string version();

/// Names and versions of the libraries in use, separated by ", ".
std::string library_versions();

/// The same as JSON: an object with `semsurf`, `libraries` (name to version), and
/// `instruction_set`, which loops for several processors run by here: results of one set are the
/// same to the last bit.
std::string version_json();

}  // namespace surf::workflow
