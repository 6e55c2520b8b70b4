// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <utility>

#include "exit_codes.h"
#include "surf/core/error.h"

namespace surf::cli {
namespace {

constexpr auto update_interval = std::chrono::milliseconds(100);

std::atomic<CancelToken*> interrupted_token{nullptr};

bool silent = false;
std::FILE* results_to = nullptr;   // null: stdout
std::FILE* messages_to = nullptr;  // null: stderr

std::string plain_words(std::string_view field, std::string_view value) {
  return last_part(field, ' ') + (value.empty() ? "" : " ") + std::string(value);
}

FieldWord field_word = plain_words;

void print_message(const char* kind, const std::string& message) {
  if (silent) return;
  fmt::print(messages(), "semsurf: {}: {}\n", kind, with_field_words(message, field_word));
}

int terminal_columns() {
  winsize size{};
  return ioctl(fileno(messages()), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

// Only calls that are safe in a signal handler.
void on_interrupt(int) {
  CancelToken* token = interrupted_token.load();
  if (!token || token->cancelled()) _exit(exit_interrupted);
  token->cancel();
  static const char text[] =
      "\nsemsurf: interrupted; writing what is done (Ctrl-C again to stop at once)\n";
  [[maybe_unused]] const auto sent = ::write(STDERR_FILENO, text, sizeof text - 1);
}

void handle_interrupts(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

std::FILE* output() { return results_to ? results_to : stdout; }
std::FILE* messages() { return messages_to ? messages_to : stderr; }
void speak_to(std::FILE* output, std::FILE* messages) {
  results_to = output;
  messages_to = messages;
}

void print_line(const std::string& label, const std::string& text) {
  print("{:<10} {}\n", label, text);
}

void print_written(const std::vector<std::filesystem::path>& files) {
  const char* label = "written";
  for (const std::filesystem::path& file : files) {
    print_line(label, file.string());
    label = "";
  }
}

void flush() {
  if (std::fflush(output()) == 0 && !std::ferror(output())) return;
  std::clearerr(output());
  throw FileError("standard output", "what was printed cannot be written there",
                  "Check the free space and where it goes");
}

void call_fields(FieldWord word) { field_word = word ? std::move(word) : plain_words; }

void be_silent(bool wanted) { silent = wanted; }

void print_error(const std::string& message) { print_message("error", message); }
void print_warning(const std::string& message) { print_message("warning", message); }
void print_note(const std::string& message) { print_message("note", message); }
int print_reasons(const std::vector<std::string>& reasons) {
  for (const std::string& reason : reasons) print_warning(reason);
  return reasons.empty() ? 0 : exit_untrustworthy;
}

std::string format_count(double count) {
  static constexpr const char* suffixes[] = {"", " k", " M", " G", " T"};
  int power = 0;
  while (count >= 999.5 && power < 4) {
    count /= 1000;
    ++power;
  }
  constexpr double most = 1e6;
  if (count >= most) return fmt::format("{:.2e}", count * std::pow(1000.0, power));
  return fmt::format("{:.{}f}{}", count, power == 0 || count >= 99.95 ? 0 : 1, suffixes[power]);
}

std::string format_bytes(double bytes) {
  std::string text = format_count(bytes);
  if (text.find(' ') == std::string::npos) text += ' ';
  return text + "B";
}

std::string format_energy(double energy_ev) {
  return energy_ev >= 1000 ? fmt::format("{:g} keV", energy_ev / 1000)
                           : fmt::format("{:g} eV", energy_ev);
}

std::string format_duration(double seconds) {
  const auto s = static_cast<long long>(std::lround(std::clamp(seconds, 0.0, 1e9)));
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60)
                  : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

ProgressBar::ProgressBar(bool wanted) : active_(wanted && !silent && isatty(fileno(messages()))) {}

ProgressBar::~ProgressBar() { clear(); }

void ProgressBar::clear() {
  if (started_) fmt::print(messages(), "\r\033[K");
}

void ProgressBar::show(double done, double total, const char* things) {
  if (!active_ || !(total > 0)) return;
  const auto now = Clock::now();
  const char* const name = things ? things : "";
  if (!started_ || things_ != name || done < last_done_) {
    started_ = true;
    things_ = name;
    start_ = next_ = now;
    done_at_start_ = done;
  }
  last_done_ = done;
  if (now < next_) return;
  next_ = now + update_interval;

  const double seconds = std::chrono::duration<double>(now - start_).count();
  const double fraction = std::clamp(done / total, 0.0, 1.0);
  std::string numbers = fmt::format(" {:3.0f} %", 100 * fraction);
  if (seconds > 0 && done > done_at_start_) {
    const double rate = (done - done_at_start_) / seconds;
    if (things) numbers += fmt::format("  {} {}/s", format_count(rate), things_);
    numbers += fmt::format("  {} left", format_duration((total - done) / rate));
  }
  const int room = terminal_columns() - static_cast<int>(numbers.size()) - 4;
  const int width = std::clamp(room, 0, 40);
  const int filled = static_cast<int>(fraction * width);
  fmt::print(messages(), "\r[{:#<{}}{: <{}}]{}\033[K", "", filled, "", width - filled, numbers);
  std::fflush(messages());
}

InterruptGuard::InterruptGuard() {
  interrupted_token.store(&token_);
  handle_interrupts(on_interrupt);
}

InterruptGuard::~InterruptGuard() {
  handle_interrupts(SIG_DFL);
  interrupted_token.store(nullptr);
}

Watch Watched::watch(double from, double to) {
  const Watch whole{[this](double done, double total) { bar_.show(done, total, nullptr); },
                    guard_.token()};
  return whole.part(from, to);
}

}  // namespace surf::cli
