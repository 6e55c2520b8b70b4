// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "checkpoint_file.h"
#include "job_identity.h"
#include "surf/mc/scheduling/unit_journal.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {

/// The work of a job that is done so far, on disk: the same job goes on from there to the same
/// bytes. A job that is done before the first write is due never writes one.
///
/// Its file begins with the job's identity, and goes on with blocks of finished units, in any
/// order; a lost block costs its units alone. Trouble in writing is a warning: the job goes on.
class Checkpoint : public mc::UnitJournal {
 public:
  using Say = std::function<void(const std::string&)>;

  /// Looks for a checkpoint to go on from, and says so through `note`, or through `warn` that it is
  /// damaged. One of another job stays as it is: under a name of its own it is noted, under the
  /// name that was asked for it is a FileError that says what differs. With `restart` all is done
  /// anew.
  Checkpoint(const CheckpointOptions& options, const std::filesystem::path& output,
             Identity identity, Say note, Say warn);

  /// Keeps what is not written yet, if the file was begun, unless `finish` was called.
  ~Checkpoint() override;

  bool recall(std::size_t unit, mc::UnitTally& tally) override;
  void record(std::size_t unit, const mc::UnitTally& tally) override;

  /// How much work there is in all, in primaries, or in pixels with a wanted accuracy; for
  /// messages.
  void expect(double work) { expected_ = work; }

  /// Writes what is not written yet. Whether there is a file now.
  bool keep();

  /// The job is done: deletes the file.
  void finish();

  const std::filesystem::path& path() const { return path_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Batch {
    std::size_t first_unit;
    CheckpointFile::Block block;
  };

  void resume();
  void note_others() const;
  bool write();
  void load(const Batch& batch);

  CheckpointOptions options_;
  std::filesystem::path path_;
  Identity identity_;
  Say note_, warn_;
  CheckpointFile file_;
  double expected_ = 0;

  std::vector<Batch> batches_;                   // to be recalled; the next one last
  std::map<std::size_t, std::string> recalled_;  // read, not asked for yet

  std::string waiting_;  // records that are not written yet
  std::size_t first_waiting_ = 0;
  std::int64_t work_waiting_ = 0;
  Clock::time_point due_;
  bool trouble_ = false;
  bool finished_ = false;
};

/// NAME.FFFFFFFF.checkpoint for an output NAME.exr, by the fingerprint of its job.
std::filesystem::path checkpoint_path(const std::filesystem::path& output,
                                      const Identity& identity);

}  // namespace surf::workflow
