// SPDX-License-Identifier: GPL-3.0-or-later
// Feeds every file of the corpus to its reader: a result or one of the project's errors, nothing
// else. The corpus was grown by the fuzzers from files of our own; each once broke or exercised a
// part of a reader.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "environment.h"
#include "targets.h"

namespace surf::test {
namespace {

namespace fs = std::filesystem;

struct CorpusFile {
  std::string name, content;
};

std::vector<CorpusFile> corpus_of(const std::string& target) {
  std::vector<CorpusFile> files;
  for (const auto& entry : fs::directory_iterator(fs::path(SEMSURF_FUZZ_CORPUS) / target)) {
    std::ifstream in(entry.path(), std::ios::binary);
    files.push_back(
        {entry.path().filename().string(), std::string(std::istreambuf_iterator(in), {})});
  }
  std::sort(files.begin(), files.end(),
            [](const CorpusFile& a, const CorpusFile& b) { return a.name < b.name; });
  return files;
}

class FuzzCorpus : public testing::TestWithParam<FuzzTarget> {
 protected:
  // No Gwyddion is found, which would be asked about unknown files.
  const Environment no_programs_{{"PATH", ""}};
};

TEST_P(FuzzCorpus, IsReadOrRefused) {
  std::size_t read = 0, refused = 0;
  for (const CorpusFile& file : corpus_of(GetParam().name)) {
    SCOPED_TRACE(file.name);
    bool was_read = false;
    EXPECT_NO_THROW(was_read = is_read(GetParam(), file.content, true));
    ++(was_read ? read : refused);
  }
  EXPECT_GT(read, 0u) << "no file of the corpus is good";
  EXPECT_GT(refused, 0u) << "no file of the corpus is bad";
}

TEST_P(FuzzCorpus, StaysReadableWhenItsMutatorChangesIt) {
  std::vector<CorpusFile> good;
  for (CorpusFile& file : corpus_of(GetParam().name))
    if (is_read(GetParam(), file.content, false)) good.push_back(std::move(file));
  ASSERT_FALSE(good.empty());
  std::size_t read = 0, changed = 0;
  constexpr std::uint32_t tries = 100;
  for (std::uint32_t seed = 0; seed < tries; ++seed) {
    const std::string& before = good[seed % good.size()].content;
    Chance chance(seed);
    const std::string after = GetParam().mutate(before, chance);
    changed += after != before;
    EXPECT_NO_THROW(read += is_read(GetParam(), after, false)) << "seed " << seed;
  }
  EXPECT_GE(changed, tries / 2);
  EXPECT_GE(read, tries * 3 / 10);
}

INSTANTIATE_TEST_SUITE_P(Formats, FuzzCorpus, testing::ValuesIn(fuzz_targets()),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace surf::test
