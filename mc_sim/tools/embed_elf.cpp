// SPDX-License-Identifier: GPL-3.0-or-later
// Turns data/elf/*.csv into a C++ source: embed_elf OUTPUT.cpp CSV...
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "embed_elf: usage: embed_elf OUTPUT.cpp CSV...\n";
    return 1;
  }
  std::ofstream out(argv[1]);
  out << "// Made by embed_elf from data/elf. Do not edit.\n"
         "#include \"physics/elf_data.h\"\n\nnamespace surf::mc {\nnamespace {\nconstexpr ElfFile "
         "files[] = {\n";
  for (int i = 2; i < argc; ++i) {
    const std::filesystem::path path = argv[i];
    std::ifstream in(path);
    std::stringstream text;
    text << in.rdbuf();
    if (!in || text.str().empty()) {
      std::cerr << "embed_elf: " << path << ": cannot be read\n";
      return 1;
    }
    out << "{\"" << path.stem().string() << "\", R\"elf(" << text.str() << ")elf\"},\n";
  }
  out << "};\n}  // namespace\n\nstd::span<const ElfFile> elf_files() { return files; }\n\n}  // "
         "namespace surf::mc\n";
  return out.good() ? 0 : 1;
}
