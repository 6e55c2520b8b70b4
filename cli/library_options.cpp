// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <iterator>

#include "common_options.h"
#include "library.h"
#include "surf/core/error.h"
#include "surf/core/some_parameters.h"
#include "surf/io/cache.h"
#include "terminal.h"

namespace surf::cli {

void describe(ParameterVisitor& visit, LibraryMaterials& materials) {
  visit(materials.names, {.name = "library.materials",
                          .help = "Material that the electrons move in",
                          .form = "MATERIAL"});
  describe_some(visit, materials.own, {{"specimen.materials"}});
}

void add_cache_option(CLI::App& app, BoundParameters& bound) {
  bound.add<workflow::LibraryParameters>(app, "Options", {}, {"job.cache"});
}

void add_library_options(CLI::App& app, LibraryOptions& o) {
  o.bound.looks["library.materials"] = {.name = "MATERIAL", .positional = true};
  o.bound.add<LibraryMaterials>(app, "Options");
  o.bound.add<workflow::LibraryParameters>(app, "Options");
  add_quiet_flag(app, o.quiet);
}

LibraryRequest read_library_options(const LibraryOptions& o) {
  LibraryMaterials wanted;
  LibraryRequest request;
  request.parameters.cache = io::cache_folder();
  o.bound.apply(wanted), o.bound.apply(request.parameters);
  if (wanted.names.empty())
    throw UsageError("library", "no material is given", "Name one or several, as Si Au");
  request.cascades = workflow::cascades_of(request.parameters);

  io::MaterialLibrary materials;
  std::vector<std::string> notes;
  for (const std::string& file : wanted.own.files) materials.read(file, notes);
  for (const std::string& note : notes)
    if (!o.quiet) print_note(note);
  for (const std::string& name : wanted.names) {
    auto libraries = workflow::libraries_of(request.parameters, materials.find(name, "library"));
    std::ranges::move(libraries, std::back_inserter(request.libraries));
  }
  return request;
}

}  // namespace surf::cli
