// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "surf/core/parameters.h"

namespace surf::workflow {

/// The provenance of a result: the version, the step's name, its parameters as `option.NAME`, and
/// its input files with their hashes. Throws FileError if an input cannot be read.
std::map<std::string, std::string> step_record(
    const std::string& step, const Record& parameters,
    const std::vector<std::filesystem::path>& inputs = {});

/// Merges the records of several parameter structs.
template <class... Struct>
Record records_of(const Struct&... of) {
  Record all;
  (all.merge(record_of(of)), ...);
  return all;
}

}  // namespace surf::workflow
