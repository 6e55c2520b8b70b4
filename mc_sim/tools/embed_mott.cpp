// SPDX-License-Identifier: GPL-3.0-or-later
// Turns data/mott/icdfx_*_Z*.csv into a C++ source with this function: embed_mott OUTPUT.cpp
// FUNCTION CSV...
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace {

[[noreturn]] void fail(const std::string& message) {
  std::cerr << "embed_mott: " << message << "\n";
  std::exit(1);
}

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> out;
  std::stringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) out.push_back(field);
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) fail("usage: embed_mott OUTPUT.cpp FUNCTION CSV...");
  std::ofstream out(argv[1]);
  out << "// Made by embed_mott from data/mott. Do not edit.\n"
         "#include \"physics/mott_data.h\"\n\nnamespace surf::mc {\nnamespace {\n";
  std::string index;
  for (int i = 3; i < argc; ++i) {
    const std::string path = argv[i];
    const auto at = path.rfind("_Z");
    if (at == std::string::npos) fail(path + ": no _Znnn in the name");
    const std::string z = std::to_string(std::stoi(path.substr(at + 2, 3)));
    std::ifstream in(path);
    std::string line;
    if (!std::getline(in, line)) fail(path + ": cannot be read");
    out << "constexpr MottRow rows_" << z << "[] = {\n";
    while (std::getline(in, line)) {
      const auto f = fields(line);
      if (f.size() != 4 + 257) fail(path + ": a row has " + std::to_string(f.size()) + " fields");
      // cm^2 to nm^2: 1e14
      out << "{" << f[0] << "," << f[1] << "*1e14," << f[2] << "*1e14," << f[3] << ",{";
      for (std::size_t k = 4; k < f.size(); ++k) out << f[k] << "f,";
      out << "}},\n";
    }
    out << "};\n";
    index += "{" + z + ", rows_" + z + "},\n";
  }
  out << "constexpr MottElement elements[] = {\n"
      << index << "};\n}  // namespace\n\n"
      << "std::span<const MottElement> " << argv[2] << "() { return elements; }\n\n"
      << "}  // namespace surf::mc\n";
  return out.good() ? 0 : 1;
}
