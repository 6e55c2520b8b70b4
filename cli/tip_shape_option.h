// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "surf/afm/tip.h"

namespace surf::cli {

/// A tip by "cone:10nm,15deg" and so on (see `semsurf tip --help`), of "N" samples across and a pixel size
/// (1 nm). Throws UsageError.
Tip parse_tip_shape(const std::string& shape, const std::string& size,
                    const std::optional<std::string>& pixel_size);

}  // namespace surf::cli
