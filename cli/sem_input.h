// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/core/placed_image.h"
#include "surf/io/sem_file.h"
#include "surf/io/sim/materials.h"
#include "surf/workflow/register_job.h"

namespace surf::cli {

/// Reads an SEM image and prints what had to be assumed, unless `quiet`. Throws UsageError,
/// FileError, InvalidInput where the pixel size is not known (also UsageError).
PlacedImage read_sem_input(const std::string& file, const io::SemReadOptions& options, bool quiet);

/// Likewise of FILE or FILE:CHANNEL, which goes before the channel of `options`.
workflow::SemInput read_sem_channel(const std::string& name, io::SemReadOptions options,
                                    bool quiet);

/// Finds a material that is named and prints what had to be assumed, unless `quiet`. Throws
/// UsageError, FileError, InvalidInput.
mc::Material read_material(const io::MaterialChoice& choice, bool quiet);

}  // namespace surf::cli
