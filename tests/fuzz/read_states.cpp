// SPDX-License-Identifier: GPL-3.0-or-later
// Targets that read what runs keep: checkpoints, tallies, states, cascades, entries of the cache.
#include <span>

#include "checkpoint_file.h"
#include "files/cache_entry.h"
#include "library_page.h"
#include "memory_files.h"
#include "reconstruction_state.h"
#include "surf/core/error.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/cascades/cascade_key.h"
#include "surf/mc/cascades/cascade_library.h"
#include "surf/mc/results/serialize.h"
#include "target_lists.h"

namespace surf::test {
namespace {

void require(bool was_read) {
  if (!was_read) throw InvalidInput("input", "it is not taken", "Do the work again");
}

Accepted checkpoint(const std::string& content) {
  workflow::CheckpointFile file;
  require(file.open(descriptor_file(content)));
  for (const auto& block : file.blocks()) file.read(block);
  require(!file.damaged() && !file.empty());
  return {};
}

Accepted tally(const std::string& content) {
  mc::deserialize(content);
  return {};
}

Accepted state(const std::string& content) {
  require(workflow::unpack(content).has_value());
  return {};
}

/// A page of cascades is taken only if it can be replayed safely; then its contents are walked.
Accepted page(const std::string& content) {
  static const mc::CascadeLibrary empty({io::find_material("Si", "material"), {}, 17.0, 1});
  const auto cascades = workflow::page_from_bytes(std::as_bytes(std::span(content)));
  require(cascades.has_value());
  mc::CascadeLibrary library = empty;
  library.add_page(std::make_shared<const mc::CascadePage>(*cascades));
  mc::describe(library, library.cascades());
  return {};
}

Accepted cache_entry(const std::string& content) {
  const io::EntryContent entry =
      io::read_entry(io::open_entry(descriptor_file(content)), io::EntryPart::payload);
  require(entry.fault.empty());
  return {};
}

Accepted page_key(const std::string& content) {
  require(mc::read_cascade_page_key(content).has_value());
  return {};
}

}  // namespace

std::vector<FuzzTarget> state_targets() {
  return {{"checkpoint", checkpoint, mutate_checkpoint},
          {"tally", tally, mutate_numbers},
          {"state", state, mutate_numbers},
          {"page", page, mutate_numbers},
          {"cache_entry", cache_entry, mutate_cache_entry},
          {"page_key", page_key, mutate_text}};
}

}  // namespace surf::test
