// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace surf::io {

/// JSON for people: objects a key per line, arrays of plain values and small objects in one line,
/// which is broken where it gets long. Numbers read back as they were. Throws InvalidInput, naming
/// the place, for a number that is not finite.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace surf::io
