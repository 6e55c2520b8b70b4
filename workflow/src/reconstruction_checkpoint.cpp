// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruction_checkpoint.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "reconstruction_state.h"
#include "surf/core/error.h"

namespace surf::workflow {
namespace {

std::string text_of(const Identity& identity) { return nlohmann::json(identity).dump(); }

Identity identity_in(const std::string& block) {
  const auto json = nlohmann::json::parse(block, nullptr, false);
  Identity identity;
  if (json.is_object())
    for (const auto& [key, value] : json.items())
      if (value.is_string()) identity[key] = value.get<std::string>();
  return identity;
}

/// Runs `work` and gives its errors a remedy for users who did not choose the file.
template <class Work>
void with_remedy(Work work) {
  try {
    work();
  } catch (const FileError& error) {
    throw FileError(error.subject(), error.reason(),
                    "Check the folder and the free space, wait if another run is at work there, "
                    "or name another folder by -o");
  }
}

}  // namespace

ReconstructionCheckpoint::ReconstructionCheckpoint(const std::filesystem::path& path,
                                                   const Identity& identity,
                                                   const NoteCallback& note) {
  with_remedy([&] {
    if (!file_.open(path)) file_.create(path);
  });
  if (!file_.blocks().empty()) {
    const Identity there = identity_in(file_.read(file_.blocks().front()));
    if (there == identity) return;
    if (note)
      note(fmt::format("{} is of another reconstruction ({}): it is begun anew", path.string(),
                       difference(there, identity)));
  }
  file_.clear();
  file_.append(text_of(identity));
}

std::optional<ReconstructionState> ReconstructionCheckpoint::found() {
  const auto& blocks = file_.blocks();
  for (std::size_t i = blocks.size(); i > 1; --i)
    if (auto state = unpack(file_.read(blocks[i - 1]))) return state;
  return std::nullopt;
}

void ReconstructionCheckpoint::keep(const ReconstructionState& state) {
  with_remedy([&] { file_.append(pack(state)); });
}

}  // namespace surf::workflow
