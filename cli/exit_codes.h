// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

namespace surf::cli {

constexpr int exit_usage = 2;          ///< the command line is wrong
constexpr int exit_unusable = 3;       ///< a file, or what it holds, cannot be used
constexpr int exit_untrustworthy = 4;  ///< there is a result, which is not to be trusted
constexpr int exit_interrupted = 130;  ///< ended by Ctrl-C, as shells say it

struct ExitCode {
  int code;
  const char* meaning;
  const char* next;  ///< what to do
};

inline constexpr std::array<ExitCode, 5> exit_codes{{
    {0, "The work is done.", "Read the warnings, if there are any."},
    {exit_usage, "The command line, or a value in a scene file, is wrong. Nothing was written.",
     "The message names the option or key, and says what is allowed."},
    {exit_unusable,
     "A file, or what it holds, cannot be used, or there is too little memory or disk. No "
     "incomplete file is left.",
     "The message names the file and what is missing."},
    {exit_untrustworthy,
     "The result is written, but is not to be trusted. The file and the messages say why.",
     "Follow the warning, or judge the result by eye."},
    {exit_interrupted,
     "The work was ended by Ctrl-C. What jobs with checkpoints or folders had done is kept.",
     "Run the same command to go on."},
}};

}  // namespace surf::cli
