// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "surf/core/volume.h"

namespace surf::io {

/// Writes a volume as VTI (ParaView, inline binary): the quantity as an array of cells, named NAME
/// with its unit in the field "unit.NAME"; metadata as fields. The file appears under its name only
/// when it is complete. Throws FileError, UsageError for another extension, Unsupported if this
/// build lacks VTK.
void write_volume(const std::filesystem::path& path, const Volume& volume);

}  // namespace surf::io
