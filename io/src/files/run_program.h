// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace surf::io {

/// How a program ended.
struct ProgramEnd {
  bool started = false;  ///< false: the program does not exist or cannot be run
  int code = 0;          ///< exit code, or 128 plus the number of the signal that ended it
  std::string errors;    ///< standard error, at most its last 64 KiB
};

/// Runs a program without a shell and waits for it. `command` is its name, looked up on the search
/// path if it has no slash, and its arguments. `input` is its standard input; its standard output
/// is discarded. Throws FileError if there is no room for a temporary file.
ProgramEnd run_program(const std::vector<std::string>& command, const std::string& input);

}  // namespace surf::io
