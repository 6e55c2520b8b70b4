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

/// The finished work of a job on disk: the same job continues from it to the same bytes. A job that
/// ends before the first write is due never writes a checkpoint.
///
/// The file begins with the job's identity. Blocks of finished units follow in any order; a lost
/// block costs only its units. An error in writing is a warning, and the job continues.
class Checkpoint : public mc::UnitJournal {
 public:
  using Say = std::function<void(const std::string&)>;

  /// Looks for a checkpoint to continue from. Reports one through `note`, or through `warn` that it
  /// is damaged. A checkpoint of another job is not touched: beside the output it is noted; if it
  /// has the requested name, FileError says what differs. With `restart` everything is simulated
  /// anew.
  Checkpoint(const CheckpointOptions& options, const std::filesystem::path& output,
             Identity identity, Say note, Say warn);

  /// Writes the records that are not written yet, if the file exists, unless `finish` was called.
  ~Checkpoint() override;

  bool recall(std::size_t unit, mc::UnitTally& tally) override;
  void record(std::size_t unit, const mc::UnitTally& tally) override;

  /// Sets the total work in primaries, or in pixels with a wanted accuracy; for messages.
  void expect(double work) { expected_ = work; }

  /// Writes the records that are not written yet. Returns whether there is a file now.
  bool keep();

  /// Deletes the file, because the job is done.
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

  std::vector<Batch> batches_;                   // to be recalled; the next one is last
  std::map<std::size_t, std::string> recalled_;  // read from the file, not requested yet

  std::string waiting_;  // records that are not written yet
  std::size_t first_waiting_ = 0;
  std::int64_t work_waiting_ = 0;
  Clock::time_point due_;
  bool trouble_ = false;
  bool finished_ = false;
};

/// The path NAME.FFFFFFFF.checkpoint for an output NAME.exr, with the fingerprint of its job.
std::filesystem::path checkpoint_path(const std::filesystem::path& output,
                                      const Identity& identity);

}  // namespace surf::workflow
