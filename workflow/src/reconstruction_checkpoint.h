// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "checkpoint_file.h"
#include "job_identity.h"
#include "model_correction.h"
#include "surf/reconstruction/reconstruct.h"

namespace surf::workflow {

/// States of a reconstruction in a file, exact to the last bit, and the corrections of its rounds.
/// The first block identifies the reconstruction.
class ReconstructionCheckpoint : public ReconstructionJournal {
 public:
  /// Replaces a file of another reconstruction and says so through `note`. Throws FileError.
  ReconstructionCheckpoint(const std::filesystem::path& path, const Identity& identity,
                           const NoteCallback& note);

  /// The last state of the round that has begun; before, of the reconstruction without corrections.
  std::optional<ReconstructionState> found() override;
  void keep(const ReconstructionState& state) override;
  /// The corrections of a round, counted from 0, of each SEM image; none: they are not known.
  std::vector<ModelCorrection> corrections(int round) const;
  /// States are of this round from now on. Keeps the corrections if they are new.
  void begin_round(int round, const std::vector<ModelCorrection>& corrections);
  /// Deletes the file, because the work is done.
  void remove() { file_.remove(); }

 private:
  struct Round {
    std::string corrections;  ///< empty for the first
    std::optional<ReconstructionState> state;
  };

  void read_rounds();

  CheckpointFile file_;
  std::vector<Round> rounds_{1};
  std::size_t now_ = 0;
};

}  // namespace surf::workflow
