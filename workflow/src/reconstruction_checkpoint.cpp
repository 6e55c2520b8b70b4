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
    if (there == identity) {
      read_rounds();
      return;
    }
    if (note)
      note(fmt::format("{} is of another reconstruction ({}): it is begun anew", path.string(),
                       difference(there, identity)));
  }
  file_.clear();
  file_.append(text_of(identity));
}

void ReconstructionCheckpoint::read_rounds() {
  const auto& blocks = file_.blocks();
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    std::string block = file_.read(blocks[i]);
    if (auto state = unpack(block)) rounds_.back().state = std::move(state);
    else if (unpack_corrections(block)) rounds_.push_back({std::move(block), {}});
  }
}

std::optional<ReconstructionState> ReconstructionCheckpoint::found() { return rounds_[now_].state; }

void ReconstructionCheckpoint::keep(const ReconstructionState& state) {
  with_remedy([&] { file_.append(pack(state)); });
}

std::vector<ModelCorrection> ReconstructionCheckpoint::corrections(int round) const {
  const auto number = static_cast<std::size_t>(round) + 1;
  if (number >= rounds_.size()) return {};
  return unpack_corrections(rounds_[number].corrections).value_or(std::vector<ModelCorrection>());
}

void ReconstructionCheckpoint::begin_round(int round,
                                           const std::vector<ModelCorrection>& corrections) {
  now_ = static_cast<std::size_t>(round) + 1;
  if (now_ < rounds_.size()) return;
  rounds_.push_back({pack(corrections), {}});
  with_remedy([&] { file_.append(rounds_.back().corrections); });
}

}  // namespace surf::workflow
