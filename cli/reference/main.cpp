// SPDX-License-Identifier: GPL-3.0-or-later
// write_reference FOLDER: writes the pages of the reference.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "pages.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "write_reference FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  for (const auto& [name, text] : surf::cli::reference::pages()) {
    std::ofstream out(folder / name, std::ios::binary);
    if (!(out << text) || !out.flush()) {
      std::fprintf(stderr, "%s cannot be written\n", (folder / name).c_str());
      return 3;
    }
  }
  return 0;
}
