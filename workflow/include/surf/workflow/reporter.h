// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "surf/core/progress.h"

namespace surf::workflow {

/// Receives a message.
using NoteCallback = std::function<void(const std::string& text)>;

/// Receives the messages and the progress of a job, and can cancel the job. All members are
/// optional. They are called from the thread that runs the job, one at a time.
struct Reporter {
  /// "tip", "model"; progress restarts at 0.
  std::function<void(const std::string& stage)> on_stage;
  /// `things` names what is counted, such as "primaries"; empty if only the share means something.
  std::function<void(double done, double total, std::string_view things)> on_progress;
  NoteCallback on_note;     ///< useful information, not a mistake
  NoteCallback on_warning;  ///< a possible mistake, and what to do about it
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

  /// For library functions that take a `ProgressCallback`. The result refers to this object.
  ProgressCallback counting(std::string_view things) const {
    return [this, things](double done, double total) { progress(done, total, things); };
  }
  /// For library functions that take a `Watch`: their progress covers `from` to `to`, in [0, 1].
  /// The result refers to this object.
  Watch watch(double from = 0, double to = 1) const {
    return Watch{[this](double done, double total) { progress(done, total); }, cancel}.part(from,
                                                                                            to);
  }
};

}  // namespace surf::workflow
