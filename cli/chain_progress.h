// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/workflow/register_job.h"
#include "terminal.h"

namespace surf::cli {

/// A bar for each stage of a chain, its notes and warnings, and Ctrl-C. One at a time.
class ChainProgress {
 public:
  explicit ChainProgress(bool quiet) : quiet_(quiet), bar_(!quiet) {}

  workflow::Reporter listener();

 private:
  bool quiet_;
  InterruptGuard interrupts_;
  ProgressBar bar_;
  std::string stage_;
};

}  // namespace surf::cli
