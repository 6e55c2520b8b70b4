// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's entry: the bytes become a file of the format that this executable is built for.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>

#include "read_input.h"
#include "temporary_folder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const surf::test::TemporaryFolder folder;
  // No Gwyddion is found, which would be asked about what is unknown: its process takes too long
  // here.
  [[maybe_unused]] static const int no_programs = ::setenv("PATH", "", 1);
  const auto path = folder.path() / "input." SEMSURF_FUZZ_FORMAT;
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  surf::test::read_input(path);
  return 0;
}
