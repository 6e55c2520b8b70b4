// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "surf/mc/results/unit_tally.h"

namespace surf::mc {

/// A tally as bytes, to keep or to send: about four per pixel and four more for each detector. The
/// same on every machine.
std::string serialize(const UnitTally& tally);

/// The tally that `serialize` was given. Throws InvalidInput for bytes that are not one.
UnitTally deserialize(std::string_view bytes);

}  // namespace surf::mc
