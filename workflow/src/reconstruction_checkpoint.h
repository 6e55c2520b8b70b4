// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "checkpoint_file.h"
#include "job_identity.h"
#include "surf/reconstruction/reconstruct.h"

namespace surf::workflow {

/// States of a reconstruction in a file, exact to the last bit. The first block identifies the
/// reconstruction.
class ReconstructionCheckpoint : public ReconstructionJournal {
 public:
  /// Replaces a file of another reconstruction and says so through `note`. Throws FileError.
  ReconstructionCheckpoint(const std::filesystem::path& path, const Identity& identity,
                           const NoteCallback& note);

  std::optional<ReconstructionState> found() override;
  void keep(const ReconstructionState& state) override;
  /// Deletes the file, because the work is done.
  void remove() { file_.remove(); }

 private:
  CheckpointFile file_;
};

}  // namespace surf::workflow
