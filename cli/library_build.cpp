// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "exit_codes.h"
#include "library.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/cache.h"
#include "surf/mc/physics/material_doubts.h"
#include "surf/workflow/library_build.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* library_build_examples =
    R"(Bytes and time grow with the energy, about in proportion: silicon at 1 keV takes 13 kB for a
cascade and some seconds for 10000. What is there already is kept and only added to; Ctrl-C
keeps whole 2048s.

Examples:
  semsurf library build Si                                10000 cascades at 1 keV
  semsurf library build Si PMMA --energy 800eV,1keV --accuracy 2%
  semsurf library build nitride --materials mine.toml --cascades 50000 --cache /data/cache)";

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
    const std::string title = workflow::library_title(
        request.libraries[i].material.name,
        request.parameters.energies_ev[i % request.parameters.energies_ev.size()]);
    const workflow::BuiltLibrary built = workflow::build_library(
        request.libraries[i], title, request.cascades, request.parameters.cache,
        request.parameters.threads,
        {[&](double done, double) { bar.show(before + done, total); }, interrupts.token()});
    bar.clear();
    for (const std::string& warning : built.warnings) print_warning(warning);
    bytes += built.bytes;
    if (options.quiet) continue;
    print("{:<18} {} cascades, {}, {:.1f} kB each; {}\n", title, built.cascades,
          format_bytes(double(built.bytes)), 1e-3 * double(built.bytes) / double(built.cascades),
          built.made == 0 ? "all were there" : fmt::format("{} are new", built.made));
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
  sub->footer(library_build_examples);
  sub->callback([options, &action] { action = [options] { return build(*options); }; });
}

}  // namespace surf::cli
