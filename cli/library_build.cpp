// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "exit_codes.h"
#include "library.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/cache.h"
#include "surf/mc/physics/material_doubts.h"
#include "surf/workflow/libraries.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* examples =
    R"(Bytes and time grow with the energy, about in proportion: silicon at 1 keV takes 13 kB for a
cascade and some seconds for 10000. What is there already is kept and only added to; Ctrl-C
keeps whole 2048s.

Examples:
  semsurf library build Si                                10000 cascades at 1 keV
  semsurf library build Si PMMA --energy 800eV,1keV --accuracy 2%
  semsurf library build nitride --materials mine.toml --cascades 50000 --cache /data/cache)";

// A library that the cache could never hold would be made over and over.
void check_size(const mc::CascadeLibrary& begun, std::size_t cascades, const std::string& title) {
  const double most = static_cast<double>(io::Cache::default_max_bytes);
  const double each = static_cast<double>(begun.bytes()) / static_cast<double>(begun.cascades());
  if (each * static_cast<double>(cascades) <= most) return;
  const auto page = static_cast<double>(mc::CascadeLibrary::page_cascades);
  const auto fit = static_cast<std::size_t>(most / each / page) * mc::CascadeLibrary::page_cascades;
  throw UsageError(
      "`library.cascades`",
      fmt::format("{} cascades of {} would take {}, but the cache keeps {} in all", cascades, title,
                  format_bytes(each * static_cast<double>(cascades)), format_bytes(most)),
      fmt::format("Ask for at most {}", fit));
}

// One library, whose bytes it returns; its cascades leave the memory when it is done.
std::uint64_t build_one(const mc::CascadeSettings& settings, const std::string& title,
                        const LibraryRequest& request, bool quiet, const Watch& watch,
                        ProgressBar& bar) {
  workflow::CachedLibraries libraries(request.parameters.cache);
  // Its first page tells how large it will be.
  auto library = libraries.library(settings, mc::CascadeLibrary::page_cascades,
                                   request.parameters.threads, watch);
  check_size(*library, request.cascades, title);
  library = libraries.library(settings, request.cascades, request.parameters.threads, watch);
  bar.clear();
  for (const std::string& note : libraries.take_notes()) print_warning(note);
  const auto pages = libraries.pages();
  if (pages.stored < pages.made)
    throw FileError(request.parameters.cache.string(), title + " cannot be kept there",
                    "Check its permissions and the free space, or choose another `job.cache`");
  if (!quiet)
    print("{:<18} {} cascades, {}, {:.1f} kB each; {}\n", title, library->cascades(),
          format_bytes(double(library->bytes())),
          1e-3 * double(library->bytes()) / double(library->cascades()),
          pages.made == 0
              ? "all were there"
              : fmt::format("{} are new", pages.made * mc::CascadeLibrary::page_cascades));
  return library->bytes();
}

int build(const LibraryOptions& options) {
  const LibraryRequest request = read_library_options(options);
  if (request.parameters.cache.empty())
    throw UsageError("`job.cache`", "there is no cache to keep libraries in", "Name a folder");
  for (std::size_t i = 0; i < request.libraries.size(); i += request.parameters.energies_ev.size())
    for (const std::string& doubt : mc::doubts(request.libraries[i].material)) print_warning(doubt);
  const double total =
      static_cast<double>(request.libraries.size()) * static_cast<double>(request.cascades);
  InterruptGuard interrupts;
  ProgressBar bar(!options.quiet);
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < request.libraries.size(); ++i) {
    const double before = static_cast<double>(i * request.cascades);
    const std::string title =
        library_title(request.libraries[i].material.name,
                      request.parameters.energies_ev[i % request.parameters.energies_ev.size()]);
    bytes += build_one(
        request.libraries[i], title, request, options.quiet,
        {[&](double done, double) { bar.show(before + done, total); }, interrupts.token()}, bar);
  }
  if (bytes > io::Cache::default_max_bytes)
    print_warning(fmt::format(
        "{} are more than the {} that the cache keeps: those built first are "
        "gone again. Build less at a time",
        format_bytes(double(bytes)), format_bytes(double(io::Cache::default_max_bytes))));
  return 0;
}

}  // namespace

void add_library_build(CLI::App& library, Action& action) {
  const auto options = std::make_shared<LibraryOptions>();
  CLI::App* sub = library.add_subcommand("build", "Make libraries and keep them in the cache");
  add_library_options(*sub, *options);
  sub->group("Commands");
  sub->footer(examples);
  sub->callback([options, &action] { action = [options] { return build(*options); }; });
}

}  // namespace surf::cli
