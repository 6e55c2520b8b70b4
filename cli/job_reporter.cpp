// SPDX-License-Identifier: GPL-3.0-or-later
#include "job_reporter.h"

namespace surf::cli {

JobReporter::JobReporter(bool quiet) : bar_(!quiet) {
  reporter_.on_stage = [this](const std::string&) { bar_.clear(); };
  reporter_.on_progress = [this](double done, double total, std::string_view things) {
    things_ = things;
    bar_.show(done, total, things_.empty() ? nullptr : things_.c_str());
  };
  reporter_.on_note = [this, quiet](const std::string& text) {
    bar_.clear();
    if (!quiet) print_note(text);
  };
  reporter_.on_warning = [this](const std::string& text) {
    bar_.clear();
    print_warning(text);
  };
  reporter_.cancel = interrupts_.token();
}

}  // namespace surf::cli
