// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/cache.h"

#include "cache_test.h"
#include "environment.h"

namespace surf::io {
namespace {

using test::age;
using test::bytes_of;
using test::complaint;
using test::path_of;
using test::text_in;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string key = "what = a library of cascades\nmaterial = Si\nenergy_ev = 1000\n";

std::vector<std::string> keys_of(const std::vector<CacheEntry>& entries) {
  std::vector<std::string> keys;
  for (const CacheEntry& entry : entries) keys.push_back(entry.key);
  return keys;
}

TEST(Cache, GivesBackWhatWasStored) {
  const test::TemporaryFolder folder;
  const std::string payload("\0one\r\ntwo\xff", 10);
  {
    Cache cache(folder.path() / "new" / "deep");
    EXPECT_EQ(cache.load(key), std::nullopt);
    EXPECT_TRUE(cache.store(key, bytes_of(payload)));
    EXPECT_EQ(text_in(cache, key), payload);
    EXPECT_EQ(text_in(cache, key + "seed = 2\n"), std::nullopt);
    EXPECT_THAT(cache.take_notes(), IsEmpty());
  }
  Cache again(folder.path() / "new" / "deep" / "");
  EXPECT_EQ(text_in(again, key), payload);
  EXPECT_TRUE(again.store(key, bytes_of("other")));
  EXPECT_EQ(text_in(again, key), "other");
  EXPECT_EQ(test::files_in(again.folder()), 1);
}

TEST(Cache, KeepsNothingAtAllAndALot) {
  const test::TemporaryFolder folder;
  Cache cache(folder.path());
  EXPECT_TRUE(cache.store("empty", {}));
  EXPECT_EQ(text_in(cache, "empty"), "");
  std::string large;  // several pieces of reading, the last one not whole
  for (int i = 0; large.size() < 1'000'003; ++i) large += std::to_string(i);
  EXPECT_TRUE(cache.store("large", bytes_of(large)));
  EXPECT_EQ(text_in(cache, "large"), large);
}

TEST(Cache, RefusesKeysThatSayNothingOrTooMuch) {
  const test::TemporaryFolder folder;
  Cache cache(folder.path());
  const std::string longest(Cache::max_key_bytes, 'k');
  EXPECT_TRUE(cache.store(longest, bytes_of("x")));
  EXPECT_EQ(text_in(cache, longest), "x");
  EXPECT_THAT(complaint<InvalidInput>([&] { cache.load(""); }), HasSubstr("key of 0 bytes"));
  EXPECT_THAT(complaint<InvalidInput>([&] { cache.store("", {}); }), HasSubstr("key of 0 bytes"));
  EXPECT_THAT(complaint<InvalidInput>([&] { cache.store(longest + "k", {}); }),
              HasSubstr("key of 1048577 bytes"));
}

TEST(Cache, ListsAndRemovesEntriesAndNothingElse) {
  const test::TemporaryFolder folder;
  Cache cache(folder.path());
  cache.store("old", bytes_of("1234"));
  cache.store("new", bytes_of("12345"));
  age(path_of(cache, "old"), 2);
  age(path_of(cache, "new"), 1);
  test::write(folder.path() / "notes.cache", "mine");
  test::write(folder.path() / std::string(64, 'a'), "mine");
  std::filesystem::create_directory(folder.path() / (std::string(64, 'b') + ".cache"));

  const std::vector<CacheEntry> entries = cache.list(Cache::Check::everything);
  EXPECT_THAT(keys_of(entries), ElementsAre("new", "old"));
  EXPECT_TRUE(entries[0].is_sound && entries[1].is_sound);
  EXPECT_EQ(entries[0].bytes, std::filesystem::file_size(entries[0].path));
  EXPECT_EQ(entries[0].bytes, entries[1].bytes + 1);

  EXPECT_TRUE(cache.remove(entries[0]));
  EXPECT_EQ(cache.load("new"), std::nullopt);
  EXPECT_EQ(text_in(cache, "old"), "1234");
  CacheEntry foreign = entries[1];
  foreign.path = folder.path() / "notes.cache";
  EXPECT_FALSE(cache.remove(foreign));
  foreign.path = folder.path() / ".." / entries[1].path.filename();
  EXPECT_FALSE(cache.remove(foreign));
  EXPECT_EQ(test::files_in(folder.path()), 4);
}

TEST(Cache, UsingAnEntryMakesItTheLastUsed) {
  const test::TemporaryFolder folder;
  Cache cache(folder.path());
  for (const char* const name : {"a", "b"}) cache.store(name, bytes_of("x"));
  age(path_of(cache, "a"), 3);
  age(path_of(cache, "b"), 2);
  EXPECT_THAT(keys_of(cache.list()), ElementsAre("b", "a"));
  cache.load("a");
  EXPECT_THAT(keys_of(cache.list()), ElementsAre("a", "b"));
}

TEST(Cache, RemovesWhatIsUnusedForLongestButNotWhatIsInUse) {
  const test::TemporaryFolder folder;
  const std::vector<std::byte> payload(1000);
  {
    Cache earlier(folder.path());
    for (const char* const name : {"a", "b", "c", "d"}) earlier.store(name, payload);
  }
  Cache cache(folder.path(), 3500);  // three entries of 1049 bytes
  int hours = 9;
  for (const char* const name : {"a", "b", "c", "d"}) age(path_of(cache, name), --hours);
  EXPECT_TRUE(cache.load("a"));
  age(path_of(cache, "a"), 100);
  EXPECT_TRUE(cache.store("e", payload));
  EXPECT_THAT(keys_of(cache.list()), ElementsAre("e", "d", "a"));

  EXPECT_TRUE(cache.store("f", payload));
  EXPECT_TRUE(cache.store("g", payload));
  EXPECT_THAT(keys_of(cache.list()), testing::UnorderedElementsAre("a", "e", "f", "g"))
      << "all in use: the limit has to wait";
  EXPECT_EQ(Cache(folder.path(), 3500).prune(), 0u) << "in use by another";
  EXPECT_THAT(cache.take_notes(), IsEmpty());
}

TEST(Cache, WhatNobodyUsesAnyLongerCanBeRemoved) {
  const test::TemporaryFolder folder;
  for (const char* const name : {"a", "b"}) {
    Cache(folder.path()).store(name, std::vector<std::byte>(1000));
  }
  Cache cache(folder.path(), 0);
  EXPECT_EQ(cache.prune(), 2 * 1049u);
  EXPECT_EQ(test::files_in(folder.path()), 0);
}

TEST(Cache, DoesNotKeepWhatIsLargerThanTheLimit) {
  const test::TemporaryFolder folder;
  Cache cache(folder.path(), 2'000'000);
  EXPECT_TRUE(cache.store("a", bytes_of("x")));
  EXPECT_FALSE(cache.store("b", std::vector<std::byte>(3'000'000)));
  EXPECT_THAT(cache.take_notes(), ElementsAre(HasSubstr("3 MB are not kept, the limit is 2 MB")));
  EXPECT_EQ(text_in(cache, "a"), "x");
}

TEST(Cache, SweepsWhatCrashedWritersLeftBehind) {
  const test::TemporaryFolder folder;
  const auto left = test::write(folder.path() / ".semsurf-123-0.tmp", "half");
  const auto fresh = test::write(folder.path() / ".semsurf-123-1.tmp", "half");
  const auto other = test::write(folder.path() / "mine.tmp", "mine");
  age(left, 25);
  age(fresh, 23);
  age(other, 25);
  EXPECT_EQ(Cache(folder.path()).prune(), 4u);
  EXPECT_FALSE(std::filesystem::exists(left));
  EXPECT_TRUE(std::filesystem::exists(fresh));
  EXPECT_TRUE(std::filesystem::exists(other));
}

TEST(CacheFolder, IsTheFirstThatIsNamed) {
  struct Case {
    const char *option, *semsurf, *xdg, *home, *expected;
  };
  for (const Case& c :
       {Case{"given", "s", "/x", "/h", "given"}, Case{"", "s", "/x", "/h", "s"},
        Case{"", nullptr, "/x", "/h", "/x/semsurf"}, Case{"", "", "/x", "/h", "/x/semsurf"},
        Case{"", nullptr, "relative", "/h", "/h/.cache/semsurf"},
        Case{"", nullptr, nullptr, "/h", "/h/.cache/semsurf"},
        Case{"", nullptr, nullptr, nullptr, ""}, Case{"off", "s", "/x", "/h", ""},
        Case{"", "off", "/x", "/h", ""}, Case{"given", "off", "/x", "/h", "given"}}) {
    const test::Environment environment{
        {"SEMSURF_CACHE", c.semsurf}, {"XDG_CACHE_HOME", c.xdg}, {"HOME", c.home}};
    EXPECT_EQ(cache_folder(c.option), c.expected);
  }
}

}  // namespace
}  // namespace surf::io
