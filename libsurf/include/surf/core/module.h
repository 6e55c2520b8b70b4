// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace surf {

// A module is a part of semsurf that stands on large libraries of others and gives its functions as
// one table. A program either links it, or loads it from a file when it is first used, so that the
// libraries behind it cost nothing before. `semsurf_module` in cmake/modules.cmake makes both;
// docs/architecture.md says which there are.

/// What a module is called and what to say where it is missing.
struct ModuleName {
  const char* name;      ///< of the file NAME.so, and of its function semsurf_module_NAME
  const char* provides;  ///< "writes VTI and VTP files"
  const char* needs;     ///< "VTK (Debian: libvtk9.1 ...)"
  int address_mb;  ///< of address space, with the threads that its libraries start when they are
                   ///< loaded
};

/// The module's table of functions; null where the module was built for another version of semsurf.
using ModuleEntry = const void* (*)(const char* version);

/// The table of the module of that name, which is loaded the first time. Throws Unsupported where
/// it is missing or cannot be loaded, with what to install. Any thread may call it.
const void* find_module(const ModuleName& module);

/// Whether `find_module` would give it. Loads it.
bool has_module(const ModuleName& module);

/// The table of functions `Table`, whose `Table::module` names it.
template <class Table>
const Table& module() {
  static const Table& table = *static_cast<const Table*>(find_module(Table::module));
  return table;
}

/// Where modules that are not linked lie: beside the program, ../lib/semsurf as a rule.
std::string module_folder();

/// Tells of a module that is linked. `name` must last.
class LinkedModule {
 public:
  LinkedModule(const char* name, ModuleEntry entry);
};

/// The version that module and program have to share.
const char* module_version();

}  // namespace surf

/// In one source of a module: says that `table` is what `find_module` gives.
#define SEMSURF_MODULE(name, table)                                             \
  extern "C" const void* semsurf_module_##name(const char* version) {           \
    return std::string(version) == surf::module_version() ? &(table) : nullptr; \
  }                                                                             \
  namespace {                                                                   \
  const surf::LinkedModule linked_module_##name(#name, &semsurf_module_##name); \
  }
