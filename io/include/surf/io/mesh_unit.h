// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

namespace surf::io {

/// The length of one unit of a mesh file, as the caller knows it.
struct MeshUnit {
  MeshUnit() = default;
  MeshUnit(double given_nm) : nm(given_nm) {}  // a bare number is a unit
  MeshUnit(std::optional<double> given_nm, bool overrides = false)
      : nm(given_nm), overrides_file(overrides) {}

  std::optional<double> nm;  ///< > 0; absent: the unit stated by the file, else 1 nm
  /// `nm` replaces a different unit stated by the file; false: a different unit is refused
  bool overrides_file = false;
};

}  // namespace surf::io
