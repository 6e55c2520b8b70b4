// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "surf/core/parameters.h"

namespace surf::workflow {

/// What a result says of how it was made: the version, the step's name, its parameters as
/// `option.NAME`, and its input files with their hashes. Throws FileError where an input cannot be
/// read.
std::map<std::string, std::string> step_record(
    const std::string& step, const Record& parameters,
    const std::vector<std::filesystem::path>& inputs = {});

/// The records of several structs of parameters as one.
template <class... Struct>
Record records_of(const Struct&... of) {
  Record all;
  (all.merge(record_of(of)), ...);
  return all;
}

}  // namespace surf::workflow
