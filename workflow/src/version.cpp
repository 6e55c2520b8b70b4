// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/version.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "surf/io/image_file.h"
#include "surf/mc/geometry/scene.h"

namespace surf::workflow {

std::string version() { return SEMSURF_VERSION; }

std::string library_versions() {
  return fmt::format("Embree {}, {}, fmt {}.{}.{}, nlohmann-json {}.{}.{}",
                     mc::ray_tracer_version(), io::image_library_versions(), FMT_VERSION / 10000,
                     FMT_VERSION / 100 % 100, FMT_VERSION % 100, NLOHMANN_JSON_VERSION_MAJOR,
                     NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH);
}

}  // namespace surf::workflow
