// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include "files/json_value.h"
#include "surf/sem/filter_bank.h"

namespace surf::io {

/// A neighbourhood of the facet model in a file. The model itself checks the ranges.
inline nlohmann::ordered_json facet_json(const FacetScale& scale) {
  return {{"size", scale.size}, {"sigma_px", scale.sigma_px}};
}

inline FacetScale facet_of(const JsonValue& value) {
  constexpr std::uint64_t largest = 1 << 20;
  const std::uint64_t size = value.require("size").whole();
  if (size > largest) value.require("size").fail("it is too large", "Train the model again");
  return {static_cast<int>(size), value.require("sigma_px").number()};
}

}  // namespace surf::io
