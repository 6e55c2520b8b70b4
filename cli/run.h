// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdio>
#include <string>
#include <vector>

namespace surf::cli {

/// The program: `arguments` are what main gets, the program's name first. Results go to `out`,
/// messages and the progress bar to `err`. Returns the exit code; nothing is thrown. One at a time.
int run(const std::vector<std::string>& arguments, std::FILE* out, std::FILE* err);

}  // namespace surf::cli
