// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "checkpoint_file.h"
#include "job_identity.h"
#include "surf/reconstruction/reconstruct.h"

namespace surf::workflow {

/// States of a reconstruction in a file, to the last bit. A first block says of which
/// reconstruction.
class ReconstructionCheckpoint : public ReconstructionJournal {
 public:
  /// A file of another reconstruction is begun anew, which `note` then says. Throws FileError.
  ReconstructionCheckpoint(const std::filesystem::path& path, const Identity& identity,
                           const NoteCallback& note);

  std::optional<ReconstructionState> found() override;
  void keep(const ReconstructionState& state) override;
  /// The work is done.
  void remove() { file_.remove(); }

 private:
  CheckpointFile file_;
};

/// A state as bytes, and back. Nothing for bytes that are no state.
std::string pack(const ReconstructionState& state);
std::optional<ReconstructionState> unpack(const std::string& bytes);

}  // namespace surf::workflow
