// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/module.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <climits>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <utility>

#include "surf/core/error.h"

namespace surf {
namespace {

// Filled before main by constructors of other source files, in any order.
struct Linked {
  const char* name;
  ModuleEntry entry;
};
constexpr int most_linked = 16;
Linked linked[most_linked];
int linked_count = 0;

[[noreturn]] void refuse(const ModuleName& module, const std::string& reason) {
  throw Unsupported(
      fmt::format("module {}", module.name),
      fmt::format("what {} cannot be used: {}", module.provides, reason),
      fmt::format("Install {} and semsurf with it: package {}", module.needs, module.package));
}

// Set by `set_module_folder`; empty: relative to the program.
std::string& given_folder() {
  static std::string folder;
  return folder;
}

// Some libraries start threads while they are loaded, and end the program if they cannot. They are
// not loaded if the address space is too small for that.
void require_address_space(const ModuleName& module) {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
  double pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const double left_mb =
      (static_cast<double>(limit.rlim_cur) - pages * static_cast<double>(sysconf(_SC_PAGESIZE))) /
      1e6;
  if (left_mb >= module.address_mb) return;
  throw Unsupported(
      fmt::format("module {}", module.name),
      fmt::format("what {} takes about {} MB of address space, and {:.0f} MB are left",
                  module.provides, module.address_mb, left_mb),
      "Raise the limit (ulimit -v)");
}

ModuleEntry loaded_entry(const ModuleName& module) {
  require_address_space(module);
  const std::string file = fmt::format("{}/{}.so", module_folder(), module.name);
  // RTLD_LOCAL: a symbol of one module must not replace a symbol that another module needs.
  void* const handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) {
    std::error_code error;
    const char* const why = dlerror();
    if (!std::filesystem::exists(file, error)) refuse(module, fmt::format("{} is not there", file));
    refuse(module, why ? why : "it cannot be loaded");
  }
  const std::string symbol = fmt::format("semsurf_module_{}", module.name);
  void* const entry = dlsym(handle, symbol.c_str());
  if (!entry) refuse(module, fmt::format("{} has no {}", file, symbol));
  return reinterpret_cast<ModuleEntry>(entry);
}

}  // namespace

LinkedModule::LinkedModule(const char* name, ModuleEntry entry) {
  if (linked_count < most_linked) linked[linked_count++] = {name, entry};
}

const char* module_version() { return SEMSURF_VERSION; }

void set_module_folder(std::string folder) { given_folder() = std::move(folder); }

std::string module_folder() {
  if (!given_folder().empty()) return given_folder();
  char program[PATH_MAX + 1];
  const ssize_t length = readlink("/proc/self/exe", program, PATH_MAX);
  if (length <= 0) return SEMSURF_MODULE_FOLDER;
  const auto folder =
      std::filesystem::path(std::string(program, static_cast<std::size_t>(length))).parent_path();
  return (folder / SEMSURF_MODULE_FOLDER).lexically_normal().string();
}

const void* find_module(const ModuleName& module) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  ModuleEntry entry = nullptr;
  for (int i = 0; i < linked_count; ++i)
    if (std::string(linked[i].name) == module.name) entry = linked[i].entry;
  if (!entry) entry = loaded_entry(module);
  const void* const table = entry(module_version());
  if (!table) refuse(module, fmt::format("it is of another version than {}", module_version()));
  return table;
}

bool has_module(const ModuleName& module) {
  try {
    return find_module(module) != nullptr;
  } catch (const Unsupported&) {
    return false;
  }
}

}  // namespace surf
