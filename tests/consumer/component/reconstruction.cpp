// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/reconstruction/reconstruct.h"

int main(int count, char**) {
  if (count > 100) surf::reconstruct(nullptr, nullptr);  // linked, not run
  return 0;
}
