// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "library.h"
#include "options.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/cache.h"
#include "surf/workflow/library_build.h"
#include "surf/workflow/library_list.h"
#include "surf/workflow/library_remove.h"
#include "terminal.h"

namespace surf::cli {
namespace {

using workflow::LibraryList;
using workflow::StoredLibrary;

constexpr const char* list_examples = R"(Examples:
  semsurf library list
  semsurf library list --check               read every file and compare its checksum
Of what is damaged or of another version nothing is ever used: it is made again.)";

constexpr const char* remove_examples = R"(Examples:
  semsurf library remove Si                  silicon at all energies
  semsurf library remove --energy 5keV       all materials at 5 keV
  semsurf library remove --all --dry-run     what that would free
  semsurf library remove --damaged)";

io::Cache open_cache(const BoundParameters& bound) {
  workflow::LibraryParameters parameters;
  parameters.cache = io::cache_folder();
  bound.apply(parameters);
  if (parameters.cache.empty())
    throw UsageError("`job.cache`", "there is no cache", "Name a folder, or unset SEMSURF_CACHE");
  return io::Cache(parameters.cache);
}

std::string format_ago(std::filesystem::file_time_type when) {
  const auto now = std::filesystem::file_time_type::clock::now();
  const double minutes = std::chrono::duration<double>(now - when).count() / 60;
  if (minutes < 2) return "just now";
  if (minutes < 120) return fmt::format("{:.0f} min ago", minutes);
  if (minutes < 48 * 60) return fmt::format("{:.0f} h ago", minutes / 60);
  return fmt::format("{:.0f} days ago", minutes / (24 * 60));
}

// What differs from the defaults.
std::string format_differences(const mc::CascadePageName& name) {
  const auto words = [](const mc::Physics& physics) {
    std::vector<std::string> out;
    const std::string text = mc::format_physics(physics);
    for (std::size_t from = 0; from < text.size();) {
      const std::size_t comma = std::min(text.find(',', from), text.size());
      out.push_back(text.substr(from, comma - from));
      from = comma + 1;
    }
    return out;
  };
  const auto usual = words({});
  std::string differences;
  const auto add = [&](const std::string& word) {
    differences += (differences.empty() ? "" : ",") + word;
  };
  for (const std::string& word : words(name.physics))
    if (std::find(usual.begin(), usual.end(), word) == usual.end()) add(word);
  if (!name.is_usual_cutoff) add(fmt::format("cutoff={:g}eV", name.physics.cutoff_ev));
  return differences.empty() ? "default" : differences;
}

void print_table(const LibraryList& list) {
  std::size_t material = 8, physics = 7;
  for (const StoredLibrary& l : list.libraries) {
    material = std::max(material, l.name.material.size());
    physics = std::max(physics, format_differences(l.name).size());
  }
  print("{:<{}}  {:>9}  {:<{}}  {:>4}  {:>9}  {:>8}  {:>9}  {:<12}  {}\n", "material", material,
        "energy", "physics", physics, "seed", "cascades", "size", "kB each", "last used", "state");
  for (const StoredLibrary& l : list.libraries)
    print("{:<{}}  {:>9}  {:<{}}  {:>4}  {:>9}  {:>8}  {:>9.1f}  {:<12}  {}\n", l.name.material,
          material, format_energy(l.name.beam_energy_ev), format_differences(l.name), physics,
          l.name.seed, l.cascades, format_bytes(double(l.bytes)),
          1e-3 * double(l.bytes) / double(std::max<std::size_t>(l.cascades, 1)),
          format_ago(l.last_used), l.name.is_current ? "good" : "of another version");
}

int list(const BoundParameters& bound, bool check) {
  const io::Cache cache = open_cache(bound);
  const LibraryList list = workflow::list_libraries(
      cache, check ? io::Cache::Check::everything : io::Cache::Check::header);
  if (list.libraries.empty()) {
    print("no libraries in {}\nMake one: semsurf library build Si --energy 1keV\n",
          cache.folder().string());
  } else {
    print_table(list);
    double bytes = 0;
    for (const StoredLibrary& l : list.libraries) bytes += double(l.bytes);
    print("{} of at most {} in {}\n", format_bytes(bytes),
          format_bytes(double(io::Cache::default_max_bytes)), cache.folder().string());
  }
  if (!list.damaged.empty())
    print_warning(fmt::format(
        "{} damaged file{} in the cache {} never used. Remove {} with "
        "'semsurf library remove --damaged'",
        list.damaged.size(), list.damaged.size() == 1 ? "" : "s",
        list.damaged.size() == 1 ? "is" : "are", list.damaged.size() == 1 ? "it" : "them"));
  return 0;
}

int remove(const BoundParameters& bound) {
  workflow::LibraryRemoval removal;
  bound.apply(removal);
  io::Cache cache = open_cache(bound);
  const workflow::RemovedLibraries removed = workflow::remove_libraries(cache, removal);
  for (const StoredLibrary& l : removed.libraries)
    print("{}, {} cascades, {}\n", workflow::library_title(l.name.material, l.name.beam_energy_ev),
          l.cascades, format_bytes(double(l.bytes)));
  if (removed.files == 0) print("nothing to remove in {}\n", cache.folder().string());
  else
    print("{} {} in {} file{}\n", removal.dry_run ? "would free" : "freed",
          format_bytes(removed.bytes), removed.files, removed.files == 1 ? "" : "s");
  return 0;
}

}  // namespace

void add_library_list(CLI::App& library, Action& action) {
  struct Options {
    BoundParameters bound;
    bool check = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* sub = library.add_subcommand("list", "The libraries in the cache");
  sub->add_flag("--check", options->check, "Read all of every file, not only its beginning");
  add_cache_option(*sub, options->bound);
  sub->group("Commands");
  sub->footer(list_examples);
  sub->callback(
      [options, &action] { action = [options] { return list(options->bound, options->check); }; });
}

void add_library_remove(CLI::App& library, Action& action) {
  const auto bound = std::make_shared<BoundParameters>();
  CLI::App* sub = library.add_subcommand("remove", "Remove libraries from the cache");
  bound->looks["library.materials"] = {.name = "MATERIAL", .positional = true};
  bound->looks["library.dry_run"] = {.name = "-n,--dry-run"};
  bound->add<workflow::LibraryRemoval>(*sub, "Options");
  add_cache_option(*sub, *bound);
  sub->group("Commands");
  sub->footer(remove_examples);
  sub->callback([bound, &action] { action = [bound] { return remove(*bound); }; });
}

}  // namespace surf::cli
