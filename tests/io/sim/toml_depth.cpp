// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/toml_depth.h"

#include "../io_test.h"
#include "sim/toml_table.h"
#include "surf/io/sim/materials.h"
#include "surf/io/sim/scene_file.h"

namespace surf::io {
namespace {

using test::complaint;
using test::write;
using testing::HasSubstr;

std::string key_of(int parts) {
  std::string key = "a";
  for (int i = 1; i < parts; ++i) key += i % 3 == 0 ? " . \"b.c\"" : ".a";
  return key;
}

std::string refused(const std::string& text) {
  return complaint<FileError>([&] { TomlTable::parse(text, "deep.toml"); });
}

TEST(TomlDepth, KeysOfAHundredThousandPartsAreRefusedWithTheirPlace) {
  const std::string deep = key_of(100'000);
  EXPECT_THAT(refused(deep + "=1"),
              HasSubstr("deep.toml, line 1, column 1: a key has more than 32 parts"));
  EXPECT_THAT(refused("title = \"x\"\n[" + deep + "]"), HasSubstr("line 2, column 2"));
  EXPECT_THAT(refused("[[" + deep + "]]"), HasSubstr("column 3"));
  EXPECT_THAT(refused("a = 1\nb = { c = 1, " + deep + " = 1 }"), HasSubstr("line 2, column 14"));
  EXPECT_THAT(refused("b = [ 1.5, { " + deep + " = 1 } ]"), HasSubstr("line 1, column 14"));
}

TEST(TomlDepth, SceneAndMaterialFilesAreRefused) {
  const test::TemporaryFolder folder;
  const auto path = write(folder.path() / "deep.toml", key_of(100'000) + "=1");
  EXPECT_THAT(complaint<FileError>([&] { read_scene(path); }), HasSubstr("32 parts"));
  std::vector<std::string> notes;
  EXPECT_THAT(complaint<FileError>([&] { MaterialLibrary().read(path, notes); }),
              HasSubstr("32 parts"));
}

TEST(TomlDepth, OrdinaryKeysAndTheMostPartsPass) {
  EXPECT_NO_THROW(TomlTable::parse(
      "[beam]\nenergy = \"1keV\"\nscan.size.x = 1.5\nat = { x.y = [ 1.0, 2.0 ] }", "a"));
  EXPECT_NO_THROW(TomlTable::parse(key_of(most_key_parts) + " = 1", "a"));
  EXPECT_THAT(refused(key_of(most_key_parts + 1) + " = 1"), HasSubstr("32 parts"));
}

TEST(TomlDepth, AsDeepAsTheLimitsLetItIsRead) {
  std::string text = "[";  // gcc 12 warns of a sum that begins with it
  text += key_of(most_key_parts) + "]\n";
  constexpr int within = 240;  // toml++ takes 256 values within each other
  for (int i = 0; i < within; ++i) text += key_of(most_key_parts) + " = { ";
  text += "a = 1";
  for (int i = 0; i < within; ++i) text += " }";
  EXPECT_NO_THROW(TomlTable::parse(text, "a"));
}

TEST(TomlDepth, DotsInTextsAndCommentsDoNotCount) {
  const std::string dots(1000, '.');
  for (const std::string& text :
       {"a = \"" + dots + "\"", "a = '" + dots + "'", "# " + dots, "a = 1 # " + dots,
        "\"" + dots + "\" = 1", "a = \"\\\"" + dots + "\"", "a = '\\' # '" + dots,
        "a = \"\"\"\n" + dots + "\n\"" + dots + "\"\"\"",
        "a = '''\n'" + dots + "\n''" + dots + "'''",
        "a = \"\"\"" + dots + "\"\"\"\"\"\nb = 1 # \"" + dots,
        "a = \"\"\"\\\"\"\"" + dots + "\"\"\"", "a = \"\" # " + dots})
    EXPECT_NO_THROW(TomlTable::parse(text, "a")) << text.substr(0, 12);
}

TEST(TomlDepth, DeepKeysBehindTextsAreFound) {
  const std::string deep = key_of(100'000) + " = 1";
  for (const char* before : {"a = \"#\"", "a = '\\'", "a = \"\"\"x\"\"\"\"\"", "a = '''x'''''",
                             "a = \"\\\\\"", "a = \"\""})
    EXPECT_THAT(refused(before + ("\n" + deep)), HasSubstr("line 2, column 1")) << before;
}

}  // namespace
}  // namespace surf::io
