// SPDX-License-Identifier: GPL-3.0-or-later
// Libraries of cascades in the cache.
#include <fmt/format.h>

#include "data.h"
#include "surf/core/error.h"
#include "surf/io/cache.h"
#include "surf/io/sim/materials.h"
#include "surf/io/sim/specimen_request.h"
#include "surf/mc/physics/material_doubts.h"
#include "surf/workflow/library_build.h"
#include "surf/workflow/library_list.h"
#include "surf/workflow/library_parameters.h"
#include "surf/workflow/library_remove.h"

namespace surf::python {
namespace {

workflow::LibraryParameters parameters_of(const Call& call) {
  workflow::LibraryParameters parameters;
  parameters.cache = io::cache_folder();
  call.apply(parameters);
  if (parameters.cache.empty())
    throw UsageError("`job.cache`", "there is no cache", "Name a folder, or unset SEMSURF_CACHE");
  return parameters;
}

bool is_asked(const Call& call, const char* argument) {
  const py::object given = call[argument];
  return !given.is_none() && py::bool_(given);
}

py::object found_of(const workflow::StoredLibrary& l) {
  py::dict d;
  d["material"] = l.name.material;
  d["energy_ev"] = l.name.beam_energy_ev;
  d["physics"] = mc::format_physics(l.name.physics);
  d["seed"] = l.name.seed;
  d["cascades"] = l.cascades;
  d["bytes"] = l.bytes;
  d["usable"] = l.name.is_current;
  return findings(d);
}

py::object list(const Call& call) {
  const io::Cache cache(parameters_of(call).cache);
  workflow::LibraryList found;
  const auto check =
      is_asked(call, "check") ? io::Cache::Check::everything : io::Cache::Check::header;
  {
    const py::gil_scoped_release unlocked;
    found = workflow::list_libraries(cache, check);
  }
  py::list all, damaged;
  for (const workflow::StoredLibrary& l : found.libraries) all.append(found_of(l));
  for (const io::CacheEntry& entry : found.damaged) damaged.append(entry.path.string());
  py::dict d;
  d["folder"] = cache.folder().string();
  d["libraries"] = all;
  d["damaged"] = damaged;
  return findings(d);
}

std::vector<std::string> names_of(const py::object& given) {
  if (PyUnicode_Check(given.ptr())) return {given.cast<std::string>()};
  std::vector<std::string> names;
  if (!PyList_Check(given.ptr()) && !PyTuple_Check(given.ptr()))
    throw UsageError("material", "it is no name", "Give 'Si', or ['Si', 'Au']");
  for (const py::handle one : given) names.push_back(py::str(one));
  return names;
}

py::object build(const Call& call) {
  const workflow::LibraryParameters parameters = parameters_of(call);
  const std::size_t cascades = workflow::cascades_of(parameters);
  io::MaterialLibrary materials;
  std::vector<std::string> notes;
  for (const std::string& file : call.told<io::MaterialChoice>().files) materials.read(file, notes);
  Call::notes(notes);
  std::vector<mc::CascadeSettings> wanted;
  std::vector<std::string> titles;
  for (const std::string& name : names_of(call["material"])) {
    const mc::Material& material = materials.find(name, "material");
    for (const std::string& doubt : mc::doubts(material)) Call::warn(doubt);
    std::ranges::move(workflow::libraries_of(parameters, material), std::back_inserter(wanted));
    for (const double energy_ev : parameters.energies_ev)
      titles.push_back(workflow::library_title(material.name, energy_ev));
  }
  std::vector<workflow::BuiltLibrary> built;
  call.work([&](const workflow::Reporter& reporter) {
    const double total = static_cast<double>(wanted.size() * cascades);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const double before = static_cast<double>(i * cascades);
      built.push_back(workflow::build_library(
          wanted[i], titles[i], cascades, parameters.cache, parameters.threads,
          {[&](double done, double) { reporter.progress(before + done, total, "primaries"); },
           reporter.cancel}));
      for (const std::string& warning : built.back().warnings) reporter.warn(warning);
    }
  });
  py::list all;
  for (std::size_t i = 0; i < built.size(); ++i) {
    py::dict d;
    d["title"] = titles[i];
    d["cascades"] = built[i].cascades;
    d["made"] = built[i].made;
    d["bytes"] = built[i].bytes;
    all.append(findings(d));
  }
  return all;
}

py::object remove(const Call& call) {
  auto removal = call.told<workflow::LibraryRemoval>();
  if (call.has("material")) removal.materials = names_of(call["material"]);
  io::Cache cache(parameters_of(call).cache);
  workflow::RemovedLibraries removed;
  {
    const py::gil_scoped_release unlocked;
    removed = workflow::remove_libraries(cache, removal);
  }
  py::list libraries;
  for (const workflow::StoredLibrary& l : removed.libraries) libraries.append(found_of(l));
  py::dict d;
  d["libraries"] = libraries;
  d["files"] = removed.files;
  d["bytes"] = removed.bytes;
  return findings(d);
}

const std::vector<std::string> all_but_cache{
    "library.energy",    "library.cascades", "library.accuracy", "simulation.physics",
    "simulation.cutoff", "simulation.seed",  "job.threads"};

}  // namespace

void add_libraries(py::module_& module) {
  Function f{.name = "libraries", .summary = "The libraries of cascades in the cache."};
  f.arguments = {{"check", "bool", "Read all of every file, not only its beginning."}};
  f.result_type = "Findings";
  f.result = "`folder`, `libraries` with their material, energy and size, and `damaged` files.";
  f.is_long = false;
  define(module, f.takes<workflow::LibraryParameters>({}, all_but_cache), list);

  Function b{.name = "build_libraries",
             .summary = "Make libraries of cascades and keep them in the cache."};
  b.details = "Simulations make what they need by themselves; this is for making it beforehand.";
  b.arguments = {{"material", "str | Sequence[str]", "Materials by name.", true, false}};
  b.takes<workflow::LibraryParameters>();
  add_keywords(b.keywords, io::MaterialChoice{}, {"specimen.material"});
  b.result_type = "list[Findings]";
  b.result = "For each library its `title`, `cascades`, how many were `made` now, and `bytes`.";
  b.example = ">>> semsurf.build_libraries('Si', energy='500eV,1keV')";
  define(module, b, build);

  Function r{.name = "remove_libraries", .summary = "Remove libraries of cascades from the cache."};
  r.details = "Simulations make them again where they are needed.";
  r.arguments = {{"material", "str | Sequence[str]", "Materials by name.", false, false}};
  add_keywords(r.keywords, workflow::LibraryRemoval{}, {"library.materials"});
  add_keywords(r.keywords, workflow::LibraryParameters{}, all_but_cache);
  r.result_type = "Findings";
  r.result = "`libraries` that were removed, or would be by `dry_run`, `files` and `bytes`.";
  r.is_long = false;
  r.example = ">>> semsurf.remove_libraries('Si', energy='5keV')";
  define(module, r, remove);
}

}  // namespace surf::python
