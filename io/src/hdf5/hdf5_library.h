// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "surf/core/image.h"
#include "surf/core/module.h"

namespace surf::io {

/// The function table of the module `hdf5`.
struct Hdf5Library {
  static constexpr ModuleName module{"hdf5", "writes HyperSpy's files",
                                     "HDF5 (Debian: libhdf5-103-1)", 50, "semsurf-io-image"};

  /// `target` is the path to write to, `file` the name for messages. Throws FileError.
  void (*write_hspy)(const std::filesystem::path& target, const std::string& file,
                     const Image& image);
};

/// Throws Unsupported, naming `file`, if the module is missing.
const Hdf5Library& hdf5_library(const std::string& file);

}  // namespace surf::io
