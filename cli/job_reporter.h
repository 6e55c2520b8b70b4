// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/workflow/reporter.h"
#include "terminal.h"

namespace surf::cli {

/// A job's reports on the terminal: a progress bar, notes and warnings that make room for
/// themselves, Ctrl-C. One at a time.
class JobReporter {
 public:
  /// `quiet`: warnings only.
  explicit JobReporter(bool quiet);
  JobReporter(const JobReporter&) = delete;
  JobReporter& operator=(const JobReporter&) = delete;

  operator const workflow::Reporter&() const { return reporter_; }
  const workflow::Reporter* operator->() const { return &reporter_; }
  /// Makes room for something to print.
  void clear() { bar_.clear(); }

 private:
  InterruptGuard interrupts_;
  ProgressBar bar_;
  std::string things_;
  workflow::Reporter reporter_;
};

}  // namespace surf::cli
