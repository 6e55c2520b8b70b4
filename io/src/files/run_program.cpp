// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "surf/core/error.h"

extern char** environ;

namespace surf::io {
namespace {

constexpr long kept_errors = 1 << 16;

using FilePointer = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void fail() {
  throw FileError("temporary file", std::strerror(errno),
                  "Check the free space of the folder for temporary files, $TMPDIR or /tmp");
}

// Files instead of pipes: no deadlock and no broken pipe, however the program behaves.
FilePointer make_file(const std::string& content) {
  FilePointer file(std::tmpfile(), &std::fclose);
  if (!file) fail();
  if (std::fwrite(content.data(), 1, content.size(), file.get()) != content.size()) fail();
  if (std::fflush(file.get()) != 0 || std::fseek(file.get(), 0, SEEK_SET) != 0) fail();
  return file;
}

std::string end_of(std::FILE* file) {
  std::fseek(file, 0, SEEK_END);
  const long size = std::max(std::ftell(file), 0L);
  std::string text(static_cast<std::size_t>(std::min(size, kept_errors)), '\0');
  std::fseek(file, -static_cast<long>(text.size()), SEEK_END);
  text.resize(std::fread(text.data(), 1, text.size(), file));
  return text;
}

class Streams {
 public:
  Streams(std::FILE* input, std::FILE* errors) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_adddup2(&actions_, fileno(input), STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions_, fileno(errors), STDERR_FILENO);
  }
  ~Streams() { posix_spawn_file_actions_destroy(&actions_); }
  Streams(const Streams&) = delete;
  Streams& operator=(const Streams&) = delete;
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

}  // namespace

ProgramEnd run_program(const std::vector<std::string>& command, const std::string& input) {
  const FilePointer in = make_file(input);
  const FilePointer errors = make_file("");
  const Streams streams(in.get(), errors.get());
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);

  ProgramEnd end;
  pid_t child = 0;
  if (::posix_spawnp(&child, arguments[0], streams.get(), nullptr, arguments.data(), environ) !=
      0) {
    return end;
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return end;
  }
  end.started = true;
  end.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  end.errors = end_of(errors.get());
  return end;
}

}  // namespace surf::io
