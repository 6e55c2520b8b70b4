// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/library_build.h"

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/io/cache.h"
#include "surf/workflow/libraries.h"

namespace surf::workflow {
namespace {

// A library that the cache could never hold would be made over and over.
void check_size(const mc::CascadeLibrary& begun, std::size_t cascades, const std::string& title) {
  const auto in_gb = [](double bytes) { return fmt::format("{:.3g} GB", 1e-9 * bytes); };
  const double most = static_cast<double>(io::Cache::default_max_bytes);
  const double each = static_cast<double>(begun.bytes()) / static_cast<double>(begun.cascades());
  if (each * static_cast<double>(cascades) <= most) return;
  const auto page = static_cast<double>(mc::CascadeLibrary::page_cascades);
  const auto fit = static_cast<std::size_t>(most / each / page) * mc::CascadeLibrary::page_cascades;
  throw UsageError(
      "`library.cascades`",
      fmt::format("{} cascades of {} would take {}, but the cache keeps {} in all", cascades, title,
                  in_gb(each * static_cast<double>(cascades)), in_gb(most)),
      fmt::format("Ask for at most {}", fit));
}

}  // namespace

std::string library_title(const std::string& material, double beam_energy_ev) {
  return beam_energy_ev >= 1000 ? fmt::format("{} at {:g} keV", material, beam_energy_ev / 1000)
                                : fmt::format("{} at {:g} eV", material, beam_energy_ev);
}

BuiltLibrary build_library(const mc::CascadeSettings& settings, const std::string& title,
                           std::size_t cascades, const std::filesystem::path& cache, int threads,
                           const Watch& watch) {
  CachedLibraries libraries(cache);
  // Its first page tells how large it will be.
  auto library = libraries.library(settings, mc::CascadeLibrary::page_cascades, threads, watch);
  check_size(*library, cascades, title);
  library = libraries.library(settings, cascades, threads, watch);
  BuiltLibrary built;
  built.warnings = libraries.take_notes();
  const auto pages = libraries.pages();
  if (pages.stored < pages.made)
    throw FileError(cache.string(), title + " cannot be kept there",
                    "Check its permissions and the free space, or choose another `job.cache`");
  built.cascades = library->cascades();
  built.made = pages.made * mc::CascadeLibrary::page_cascades;
  built.bytes = library->bytes();
  return built;
}

}  // namespace surf::workflow
