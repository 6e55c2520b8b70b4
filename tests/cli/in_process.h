// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdio.h>
#include <stdlib.h>

#include <string>
#include <vector>

#include "run.h"

namespace surf::test {

/// What the program says, on stdout and stderr, and its exit code.
struct Said {
  int code = 0;
  std::string out, err;
};

/// `semsurf ARGUMENTS...` within this process.
inline Said semsurf(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "semsurf");
  char *out = nullptr, *err = nullptr;
  size_t out_size = 0, err_size = 0;
  FILE* const out_file = open_memstream(&out, &out_size);
  FILE* const err_file = open_memstream(&err, &err_size);
  Said said;
  said.code = cli::run(arguments, out_file, err_file);
  fclose(out_file);
  fclose(err_file);
  said.out.assign(out, out_size);
  said.err.assign(err, err_size);
  free(out);
  free(err);
  return said;
}

}  // namespace surf::test
