// SPDX-License-Identifier: GPL-3.0-or-later
// Feeds every file of the corpus to its reader: a result or one of the project's errors, nothing
// else. The corpus was grown by the fuzzers from files of our own; each once broke or exercised a
// part of a reader.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "read_input.h"
#include "temporary_folder.h"

namespace surf::test {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  return paths;
}

class FuzzCorpus : public testing::TestWithParam<fs::path> {};

TEST_P(FuzzCorpus, IsReadOrRefused) {
  const TemporaryFolder folder;
  const fs::path input = folder.path() / ("input." + GetParam().filename().string());
  std::size_t read = 0, refused = 0;
  for (const fs::path& path : entries(GetParam())) {
    SCOPED_TRACE(path.filename());
    fs::copy_file(path, input, fs::copy_options::overwrite_existing);
    bool was_read = false;
    EXPECT_NO_THROW(was_read = read_input(input));
    ++(was_read ? read : refused);
  }
  EXPECT_GT(read, 0u) << "no file of the corpus is good";
  EXPECT_GT(refused, 0u) << "no file of the corpus is bad";
}

INSTANTIATE_TEST_SUITE_P(Formats, FuzzCorpus, testing::ValuesIn(entries(SEMSURF_FUZZ_CORPUS)),
                         [](const auto& test) { return test.param.filename().string(); });

}  // namespace
}  // namespace surf::test
