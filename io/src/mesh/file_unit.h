// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "surf/io/mesh_unit.h"

namespace surf::io {

/// Throws UsageError unless the unit is positive and finite.
void check_unit(double unit_nm, const std::string& file);

/// The length of one file unit in nm. `stated_nm` is the unit stated by the file or its format. If
/// no unit is stated or given, the result is 1. Throws UsageError if the given unit is invalid, or
/// if it differs from the file's and does not override it.
double file_unit_nm(const MeshUnit& given, std::optional<double> stated_nm,
                    const std::string& file);

}  // namespace surf::io
