// SPDX-License-Identifier: GPL-3.0-or-later
#include "chain_progress.h"

#include <fmt/format.h>

namespace surf::cli {

workflow::Reporter ChainProgress::listener() {
  workflow::Reporter l;
  l.stage = [this](const std::string& stage) {
    bar_.clear();
    stage_ = stage;
  };
  l.progress = [this](double done, double total) { bar_.show(done, total, nullptr); };
  l.note = [this](const std::string& note) {
    bar_.clear();
    if (!quiet_) print_note(note);
  };
  l.warn = [this](const std::string& warning) {
    bar_.clear();
    print_warning(warning);
  };
  l.cancel = interrupts_.token();
  return l;
}

}  // namespace surf::cli
