// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "surf/io/mesh_unit.h"

namespace surf::io {

/// Throws UsageError unless it is positive and finite.
void check_unit(double unit_nm, const std::string& file);

/// The nm that one unit of a file stands for. `stated_nm` is what the file or its format says;
/// without a word and without a given unit it is 1. Throws UsageError where the given unit is none,
/// or is another one than the file's and does not override it.
double file_unit_nm(const MeshUnit& given, std::optional<double> stated_nm,
                    const std::string& file);

}  // namespace surf::io
