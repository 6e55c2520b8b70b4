// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's entry: the bytes become a file of the format that this executable is built for.
#include <cstddef>
#include <cstdint>
#include <fstream>

#include "read_input.h"
#include "temporary_folder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const surf::test::TemporaryFolder folder;
  const auto path = folder.path() / "input." SEMSURF_FUZZ_FORMAT;
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  surf::test::read_input(path);
  return 0;
}
