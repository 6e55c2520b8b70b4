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

  std::optional<double> nm;  ///< > 0; absent: what the file says, else 1 nm
  bool overrides_file =
      false;  ///< `nm` counts even where the file says another unit; else that is refused
};

}  // namespace surf::io
