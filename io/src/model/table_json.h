// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include "files/json_value.h"

namespace surf::io {

/// The layout of a table of rings and heights, and an empty array of channels.
template <class Parameters>
nlohmann::ordered_json table_json(const Parameters& p) {
  return {{"ring_nm", p.ring_nm},     {"rings", p.rings},
          {"lowest_nm", p.lowest_nm}, {"height_step_nm", p.height_step_nm},
          {"heights", p.heights},     {"channels", nlohmann::ordered_json::array()}};
}

/// Reads the layout. The model itself checks the ranges.
template <class Parameters>
void read_table(const JsonValue& value, Parameters& p) {
  const auto count = [&](const char* key) {
    const std::uint64_t n = value.require(key).whole();
    if (n > 1 << 20) value.require(key).fail("it is too large", "Make the table again");
    return static_cast<int>(n);
  };
  p.ring_nm = value.require("ring_nm").number();
  p.rings = count("rings");
  p.lowest_nm = value.require("lowest_nm").number();
  p.height_step_nm = value.require("height_step_nm").number();
  p.heights = count("heights");
  value.require("channels");
}

}  // namespace surf::io
