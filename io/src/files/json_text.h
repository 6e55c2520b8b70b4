// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace surf::io {

/// Formats JSON for people: objects with one key per line, arrays of plain values and small objects
/// in one line, which is broken if it gets long. Numbers read back exactly. Throws InvalidInput,
/// naming the place, for a number that is not finite.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace surf::io
