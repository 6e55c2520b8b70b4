// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "surf/core/field_words.h"
#include "surf/core/progress.h"

namespace surf::cli {

/// Where results go and where messages go: stdout and stderr until somebody else is named.
std::FILE* output();
std::FILE* messages();
void speak_to(std::FILE* output, std::FILE* messages);

/// A command's result, to `output()`.
template <class... T>
void print(fmt::format_string<T...> format, T&&... values) {
  fmt::vprint(output(), format, fmt::make_format_args(values...));
}
/// "LABEL      TEXT": a line of a summary.
void print_line(const std::string& label, const std::string& text);
/// "written" and the name of each file, one a line; the others, that belong to the first, without
/// the word.
void print_written(const std::vector<std::filesystem::path>& files);
/// What was printed can be read now. Throws FileError if it cannot be kept, as on a full disk.
void flush();

/// How fields are called in messages from now on; as plain words, until this is called.
void call_fields(FieldWord word);

/// "semsurf: error: ...", "semsurf: warning: ..." and "semsurf: note: ..." in the messages, fields
/// in backticks as they are called.
void print_error(const std::string& message);
void print_warning(const std::string& message);
void print_note(const std::string& message);
/// Why a result is not to be trusted, as warnings, and the exit code that says so; 0 without any.
int print_reasons(const std::vector<std::string>& reasons);

/// Whether these say anything, and a progress bar: not where another process does.
void be_silent(bool silent = true);

/// "13.1 M", "950": a count for people.
std::string format_count(double count);

/// "13.1 MB", "950 B".
std::string format_bytes(double bytes);

/// "1 keV", "500 eV".
std::string format_energy(double energy_ev);

/// "0:07", "3:21", "2:05:00".
std::string format_duration(double seconds);

/// A progress bar among the messages: percentage, things per second, time left. Silent unless
/// `wanted` and they go to a terminal. Erased when destroyed.
class ProgressBar {
 public:
  explicit ProgressBar(bool wanted);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `things` are what is counted, null if it is nothing; other things than before begin a new bar.
  void show(double done, double total, const char* things = "primaries");

  /// Makes room for a message; the bar comes back with the next `show`.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  bool active_;
  bool started_ = false;
  double done_at_start_ = 0;  // a resumed job begins in the middle
  double last_done_ = 0;
  std::string things_;
  Clock::time_point start_, next_;
};

/// While one exists, the first SIGINT or SIGTERM cancels its token; the second ends the program at
/// once. One at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  const CancelToken* token() const { return &token_; }

 private:
  CancelToken token_;
};

/// A bar and Ctrl-C for work that takes a `Watch`. One at a time.
class Watched {
 public:
  explicit Watched(bool bar_wanted) : bar_(bar_wanted) {}

  /// Of the part of the command's work from `from` to `to`, in [0, 1].
  Watch watch(double from = 0, double to = 1);
  /// Makes room for a message.
  void clear() { bar_.clear(); }

 private:
  InterruptGuard guard_;
  ProgressBar bar_;
};

}  // namespace surf::cli
