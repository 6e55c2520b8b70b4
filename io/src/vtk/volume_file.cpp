// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/volume_file.h"

#include "surf/core/error.h"
#include "surf/io/files.h"
#include "vtk_library.h"

namespace surf::io {

void write_volume(const std::filesystem::path& path, const Volume& volume) {
  if (path.extension() != ".vti")
    throw UsageError(path.string(), "volumes are written as VTI", "Choose a name ending in .vti");
  const VtkLibrary& vtk = vtk_library(path.string());
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    vtk.write_volume(temporary, path.string(), volume);
  });
}

}  // namespace surf::io
