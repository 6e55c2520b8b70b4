// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "surf/core/progress.h"

namespace surf::workflow {

/// Is told something in words.
using NoteCallback = std::function<void(const std::string& text)>;

/// Who hears what a job does, and can end it. All members may be left out. They are called from the
/// thread that runs the job, one at a time.
struct Reporter {
  std::function<void(const std::string& stage)> on_stage;  ///< "tip", "model": progress begins anew
  /// `things` is what is counted, "primaries"; empty where only the share counts.
  std::function<void(double done, double total, std::string_view things)> on_progress;
  NoteCallback on_note;     ///< good to know, and no mistake
  NoteCallback on_warning;  ///< may be a mistake, and what to do about it
  const CancelToken* cancel = nullptr;

  void stage(const std::string& name) const {
    if (on_stage) on_stage(name);
  }
  void progress(double done, double total, std::string_view things = {}) const {
    if (on_progress) on_progress(done, total, things);
  }
  void note(const std::string& text) const {
    if (on_note) on_note(text);
  }
  void warn(const std::string& text) const {
    if (on_warning) on_warning(text);
  }
  bool cancelled() const { return cancel && cancel->cancelled(); }

  /// For library work that takes a `ProgressCallback`. Refers to this.
  ProgressCallback counting(std::string_view things) const {
    return [this, things](double done, double total) { progress(done, total, things); };
  }
  /// For library work that takes a `Watch`: all of it is told as `from` to `to`, in [0, 1]. Refers
  /// to this.
  Watch watch(double from = 0, double to = 1) const {
    return Watch{[this](double done, double total) { progress(done, total); }, cancel}.part(from,
                                                                                            to);
  }
};

}  // namespace surf::workflow
