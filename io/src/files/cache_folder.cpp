// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdlib>

#include "surf/io/cache.h"

namespace surf::io {
namespace {

/// The variable's text, empty where it is not set.
std::string environment(const char* name) {
  const char* const text = std::getenv(name);
  return text ? text : "";
}

}  // namespace

std::filesystem::path cache_folder(const std::string& option) {
  for (const std::string& asked : {option, environment("SEMSURF_CACHE")}) {
    if (asked == "off") return {};
    if (!asked.empty()) return asked;
  }
  const std::filesystem::path caches = environment("XDG_CACHE_HOME");
  if (caches.is_absolute()) return caches / "semsurf";
  const std::filesystem::path home = environment("HOME");
  if (home.is_absolute()) return home / ".cache" / "semsurf";
  return {};
}

}  // namespace surf::io
