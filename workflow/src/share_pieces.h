// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/progress.h"
#include "surf/workflow/team.h"

namespace surf::workflow {

/// What one process has made of a piece of work.
struct FinishedPiece {
  std::int64_t primaries = 0;
  std::string outcome;  ///< for whoever leads
};

/// Work in pieces that one process each does alone, with all its threads: whole images, where these
/// are so small that several processes would mostly wait for each other at the ends of each.
struct Pieces {
  std::vector<double> weights;  ///< of each piece, for progress: so many there are
  /// Does a piece; nothing when it was cancelled. Never uses the team. Called by one thread, not
  /// the caller's.
  std::function<std::optional<FinishedPiece>(std::size_t piece, const ProgressCallback& progress)>
      work;
  /// Called where the team is led, for all pieces, in the order in which they are finished.
  std::function<void(std::size_t piece, const std::string& outcome)> finished;
  ProgressCallback progress;  ///< where the team is led; in weights
  /// Held while `finished` and `progress` are called; for whatever else talks meanwhile.
  std::mutex* talking = nullptr;
  int threads = 1;
  const CancelToken* cancel = nullptr;
};

/// Who did how much.
struct MemberTally {
  std::int64_t pieces = 0, primaries = 0;
  double seconds = 0;  ///< at work on pieces
};

/// Whoever is free does the next piece. Whether all are done, the same for all of the team; false
/// when cancelled. An error anywhere ends it everywhere. Adds to the tallies, by rank, where the
/// team is led.
bool share_pieces(Team& team, const Pieces& pieces, std::vector<MemberTally>& tallies);

/// How many of so many images are to be pieces, the first ones; the others are shared unit by unit,
/// one after another. All where they come out even, or nearly; few that are left over keep all
/// processes busy only together. That costs their scenes and libraries one after another, and takes
/// `units` enough in each. Counts work, not time: it is the same for all.
std::size_t pieces_of(std::size_t images, std::size_t units, int members);

/// Throws FileError, on all, where the members do not see the same folder. Makes it if it is not
/// there.
void check_same_folder(Team& team, const std::filesystem::path& folder);

/// Waits until `there`, for what another member has written: file systems of networks show it late.
/// Throws FileError after a minute.
void await_file(const std::filesystem::path& file, const std::function<bool()>& there);

}  // namespace surf::workflow
