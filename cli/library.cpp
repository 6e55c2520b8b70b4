// SPDX-License-Identifier: GPL-3.0-or-later
#include "library.h"

#include "surf/core/error.h"

namespace surf::cli {
namespace {

constexpr const char* library_examples =
    R"(A library holds cascades: primaries of one energy in one endless material, each with all its
secondaries. Simulations replay them. What is missing they make and keep in the cache, so
this command is needed only to do so beforehand, to look at them, or to make room.

Examples:
  semsurf library build Si Au --energy 1keV,5keV     before a series of images
  semsurf library list                               what there is
  semsurf library plot Si -o si.svg --energy 500eV,1keV,2keV,5keV
                                                     how far electrons get, how many come out
  semsurf library remove Si --energy 5keV            make room

The cache is $SEMSURF_CACHE, else $XDG_CACHE_HOME/semsurf, else ~/.cache/semsurf. It keeps
4 GB and then drops what was unused for longest. 'semsurf library build --help' says more.)";

}  // namespace

void add_library(CLI::App& app, Action& action) {
  CLI::App* sub = app.add_subcommand("library", "Libraries of cascades that simulations replay");
  sub->footer(library_examples);
  add_library_list(*sub, action);
  add_library_build(*sub, action);
  add_library_plot(*sub, action);
  add_library_remove(*sub, action);
  sub->callback([sub, &action] {
    if (!sub->get_subcommands().empty()) return;
    action = []() -> int {
      throw UsageError("library", "what to do is not given", "Choose list, build, plot or remove");
    };
  });
}

}  // namespace surf::cli
