// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace surf::io {

/// How a program ended.
struct ProgramEnd {
  bool started = false;  ///< false: there is no such program, or it cannot be run
  int code = 0;          ///< what it returned, or 128 and the number of the signal that ended it
  std::string errors;    ///< what it wrote to its standard error, at most its last 64 KiB
};

/// Runs a program, without a shell, and waits for it. `command` is its name, looked up on the
/// search path where it has no slash, and its arguments. `input` is what it reads on its standard
/// input; what it writes to its standard output is dropped. Throws FileError where there is no room
/// for a temporary file.
ProgramEnd run_program(const std::vector<std::string>& command, const std::string& input);

}  // namespace surf::io
