// SPDX-License-Identifier: GPL-3.0-or-later
// The commands of good.cmake and bad.cmake, each in a fresh folder that holds the files of data/,
// all in this process.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "in_process.h"
#include "temporary_folder.h"

namespace surf::cli {
namespace {

namespace fs = std::filesystem;

struct Case {
  std::string suite, name;
  int exit = 0;
  std::vector<std::string> arguments;
  std::vector<std::string> out, err, writes;  // regular expressions, and files
  std::optional<std::string> info_file;
  std::vector<std::string> info;
};

/// One thing a line, as tests/cli/CMakeLists.txt writes them.
std::vector<Case> read_cases() {
  std::vector<Case> cases;
  std::ifstream in(SEMSURF_CLI_CASES);
  for (std::string line; std::getline(in, line);) {
    const std::size_t space = line.find(' ');
    const std::string kind = line.substr(0, space),
                      value = space == std::string::npos ? "" : line.substr(space + 1);
    if (kind == "CASE") {
      Case& c = cases.emplace_back();
      const std::size_t dot = value.find('.');
      c.suite = "cli_" + (dot == std::string::npos ? "program" : value.substr(0, dot));
      c.name = dot == std::string::npos ? value : value.substr(dot + 1);
      std::ranges::replace(c.name, '.', '_');
    } else if (kind == "EXIT") {
      cases.back().exit = std::stoi(value);
    } else if (kind == "ARG") {
      cases.back().arguments.push_back(value);
    } else if (kind == "STDOUT") {
      cases.back().out.push_back(value);
    } else if (kind == "STDERR") {
      cases.back().err.push_back(value);
    } else if (kind == "WRITES") {
      cases.back().writes.push_back(value);
    } else if (kind == "INFO_FILE") {
      cases.back().info_file = value;
    } else if (kind == "INFO") {
      cases.back().info.push_back(value);
    }
  }
  return cases;
}

std::set<std::string> files_here() {
  std::set<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator("."))
    if (entry.is_regular_file()) files.insert(entry.path().lexically_normal().string());
  return files;
}

bool matches(const std::string& text, const std::string& pattern) {
  return std::regex_search(text, std::regex(pattern));
}

int lines_that_begin(const std::string& text, const std::string& with) {
  int count = 0;
  for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
    if (text.compare(at, with.size(), with) == 0) ++count;
    if (text.find('\n', at) == std::string::npos) break;
  }
  return count;
}

class Command : public testing::Test {
 public:
  explicit Command(const Case& c) : case_(c) {}

  void SetUp() override {
    before_ = fs::current_path();
    fs::copy(SEMSURF_CLI_DATA, folder_.path(), fs::copy_options::recursive);
    fs::current_path(folder_.path());
  }
  void TearDown() override { fs::current_path(before_); }

  void TestBody() override {
    const std::set<std::string> old = files_here();
    const test::Said said = test::semsurf(case_.arguments);
    SCOPED_TRACE("--- output\n" + said.out + "--- messages\n" + said.err + "---");
    EXPECT_EQ(said.code, case_.exit);
    for (const std::string& pattern : case_.out)
      EXPECT_TRUE(matches(said.out, pattern)) << "the output does not match '" << pattern << "'";
    for (const std::string& pattern : case_.err)
      EXPECT_TRUE(matches(said.err, pattern)) << "the messages do not match '" << pattern << "'";
    std::set<std::string> added = files_here();
    for (const std::string& file : old) added.erase(file);
    if (case_.exit == 2 || case_.exit == 3) {
      EXPECT_TRUE(added.empty()) << *added.begin() << " is left behind";
      EXPECT_EQ(lines_that_begin(said.err, "semsurf: error: "), 1);
    }
    for (const std::string& file : case_.writes)
      EXPECT_EQ(added.count(fs::path(file).lexically_normal().string()), 1u)
          << file << " was not written";
    if (case_.info_file) {
      const test::Said info = test::semsurf({"info", *case_.info_file});
      for (const std::string& pattern : case_.info)
        EXPECT_TRUE(matches(info.out, pattern)) << "info does not match '" << pattern << "':\n"
                                                << info.out;
    }
  }

 private:
  const Case& case_;
  test::TemporaryFolder folder_;
  fs::path before_;
};

}  // namespace
}  // namespace surf::cli

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  setenv("SEMSURF_CACHE", "off", 1);
  setenv("OPENBLAS_NUM_THREADS", "1", 0);
  const std::vector<surf::cli::Case> cases = surf::cli::read_cases();
  for (const surf::cli::Case& c : cases)
    testing::RegisterTest(c.suite.c_str(), c.name.c_str(), nullptr, nullptr, __FILE__, __LINE__,
                          [&c]() -> testing::Test* { return new surf::cli::Command(c); });
  return RUN_ALL_TESTS();
}
