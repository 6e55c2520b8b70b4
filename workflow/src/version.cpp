// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/version.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "surf/core/instruction_set.h"
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

std::string version_json() {
  nlohmann::ordered_json out{{"semsurf", version()}};
  // "Embree 3.13.5, fmt 9.1.0": a name, a space and a version each.
  const std::string all = library_versions();
  for (std::size_t at = 0; at < all.size();) {
    const std::size_t end = std::min(all.find(", ", at), all.size());
    const std::string one = all.substr(at, end - at);
    const std::size_t space = one.rfind(' ');
    out["libraries"][one.substr(0, space)] = one.substr(space + 1);
    at = end + 2;
  }
  out["instruction_set"] = instruction_set();
  return out.dump(2);
}

}  // namespace surf::workflow
