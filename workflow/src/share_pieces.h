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

/// The result of a piece of work.
struct FinishedPiece {
  std::int64_t primaries = 0;
  std::string outcome;  ///< for the leader
};

/// Work in pieces. One process does each piece alone with all its threads. Pieces are whole images
/// that are so small that several processes would mostly wait for each other at the end of each.
struct Pieces {
  std::vector<double> weights;  ///< one weight per piece, for progress
  /// Does a piece; returns nothing if cancelled. Never uses the team. Called by one thread, which
  /// is not the caller's.
  std::function<std::optional<FinishedPiece>(std::size_t piece, const ProgressCallback& progress)>
      work;
  /// Called on the leader for all pieces, in the order in which they finish.
  std::function<void(std::size_t piece, const std::string& outcome)> finished;
  ProgressCallback progress;  ///< called on the leader; in weights
  /// Held while `finished` and `progress` are called; also for other messages meanwhile.
  std::mutex* talking = nullptr;
  int threads = 1;
  const CancelToken* cancel = nullptr;
};

/// The work of one member.
struct MemberTally {
  std::int64_t pieces = 0, primaries = 0;
  double seconds = 0;  ///< time spent on pieces
};

/// Each free process does the next piece. Returns whether all pieces are done, the same on all
/// members; false if cancelled. An error on one member ends the work on all. Adds to the tallies,
/// by rank, on the leader.
bool share_pieces(Team& team, const Pieces& pieces, std::vector<MemberTally>& tallies);

/// How many of the images, the first ones, are done as pieces. The others are shared unit by unit,
/// one after another. All are pieces if they divide evenly among the members, or nearly so. A few
/// images left over keep all processes busy only if they are shared. Sharing builds their scenes
/// and libraries one after another, and needs enough `units` in each image. The result depends on
/// the work, not on time: it is the same on all members.
std::size_t pieces_of(std::size_t images, std::size_t units, int members);

/// Throws FileError on all members if they do not see the same folder. Creates the folder if it is
/// missing.
void check_same_folder(Team& team, const std::filesystem::path& folder);

/// Waits until `there` returns true, for a file of another member: network file systems show files
/// late. Throws FileError after a minute.
void await_file(const std::filesystem::path& file, const std::function<bool()>& there);

}  // namespace surf::workflow
