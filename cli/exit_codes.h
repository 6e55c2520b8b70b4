// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace surf::cli {

constexpr int exit_usage = 2;           ///< the command line is wrong
constexpr int exit_unusable = 3;        ///< a file, or what it holds, cannot be used
constexpr int exit_untrustworthy = 4;   ///< there is a result, which is not to be trusted
constexpr int exit_interrupted = 130;   ///< ended by Ctrl-C, as shells say it

}  // namespace surf::cli
