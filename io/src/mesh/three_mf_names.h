// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string_view>

namespace surf::io {

// Names in 3MF packages (3MF Core Specification 1.3, 3mf.io).
inline constexpr const char* three_mf_core =
    "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
inline constexpr const char* three_mf_model_relation =
    "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
/// Namespace of semsurf's own metadata, whose names are "semsurf:...".
inline constexpr const char* three_mf_own = "urn:semsurf:surface:1";
inline constexpr const char* three_mf_magnification = "semsurf:magnification";
inline constexpr const char* three_mf_exaggeration = "semsurf:z_exaggeration";
inline constexpr const char* three_mf_unit = "semsurf:unit";
inline constexpr const char* three_mf_metadata = "semsurf:metadata";  // a JSON object of texts

struct ThreeMfUnit {
  std::string_view name;
  double nm;
};
inline constexpr std::array<ThreeMfUnit, 6> three_mf_units{{{"micron", 1e3},
                                                            {"millimeter", 1e6},
                                                            {"centimeter", 1e7},
                                                            {"inch", 25.4e6},
                                                            {"foot", 304.8e6},
                                                            {"meter", 1e9}}};

}  // namespace surf::io
