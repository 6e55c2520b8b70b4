// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace surf {

// A module is a part of semsurf that needs large third-party libraries. It offers its functions in
// one table. A program either links the module or loads it from a file on first use, so that unused
// libraries cost nothing. `semsurf_module` in cmake/modules.cmake builds both forms;
// docs/development/architecture.md lists the modules.

/// The name of a module, and the texts for the message that it is missing.
struct ModuleName {
  const char* name;      ///< the file is NAME.so, the function in it semsurf_module_NAME
  const char* provides;  ///< "writes VTI and VTP files"
  const char* needs;     ///< "VTK (Debian: libvtk9.1 ...)"
  /// Address space that loading needs, including the threads that the libraries start.
  int address_mb;
  const char* package = "semsurf";  ///< of semsurf, that it is in (docs/how-to/packages.md)
};

/// Returns the module's table of functions, or null if the module was built for another version of
/// semsurf.
using ModuleEntry = const void* (*)(const char* version);

/// The table of functions of `module`, which is loaded on first use. Throws Unsupported, and says
/// what to install, if the module is missing or cannot be loaded. Thread-safe.
const void* find_module(const ModuleName& module);

/// Whether `find_module` succeeds. Loads the module.
bool has_module(const ModuleName& module);

/// The table of functions of type `Table`. `Table::module` names its module.
template <class Table>
const Table& module() {
  static const Table& table = *static_cast<const Table*>(find_module(Table::module));
  return table;
}

/// The folder of the modules that are not linked: usually ../lib/semsurf, relative to the program.
std::string module_folder();

/// Sets this folder, for code of semsurf that a foreign program has loaded (Python). To be called
/// before any module is used.
void set_module_folder(std::string folder);

/// Registers a linked module. `name` must stay valid.
class LinkedModule {
 public:
  LinkedModule(const char* name, ModuleEntry entry);
};

/// The version that a module and the program must have in common.
const char* module_version();

}  // namespace surf

/// To be used in one source file of a module: makes `table` the result of `find_module`.
#define SEMSURF_MODULE(name, table)                                             \
  extern "C" const void* semsurf_module_##name(const char* version) {           \
    return std::string(version) == surf::module_version() ? &(table) : nullptr; \
  }                                                                             \
  namespace {                                                                   \
  const surf::LinkedModule linked_module_##name(#name, &semsurf_module_##name); \
  }
