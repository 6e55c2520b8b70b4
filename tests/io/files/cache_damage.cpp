// SPDX-License-Identifier: GPL-3.0-or-later
// What is not right to the last bit is not used, and a folder that cannot be used is no error.
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cache_test.h"

namespace surf::io {
namespace {

using test::bytes_of;
using test::path_of;
using test::text_in;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string key = "what = test\nnumber = 1\n";
const std::string payload = "the payload";

/// A folder with one sound entry.
class CacheDamage : public testing::Test {
 protected:
  CacheDamage() : cache(folder.path()) {
    cache.store(key, bytes_of(payload));
    path = path_of(cache, key);
    sound = test::content_of(path);
  }

  void expect_absent(const std::string& content, const std::string& because) {
    test::write(path, content);
    EXPECT_EQ(cache.load(key), std::nullopt) << because;
    cache.take_notes();
    const std::vector<CacheEntry> entries = cache.list(Cache::Check::everything);
    ASSERT_EQ(entries.size(), 1u);
    EXPECT_FALSE(entries[0].is_sound) << because;
  }

  /// What a new cache says of this content.
  std::vector<std::string> notes_on(const std::string& content) {
    test::write(path, content);
    Cache fresh(folder.path());
    EXPECT_EQ(fresh.load(key), std::nullopt);
    return fresh.take_notes();
  }

  const test::TemporaryFolder folder;
  Cache cache;
  std::filesystem::path path;
  std::string sound;
};

TEST_F(CacheDamage, EveryTruncationIsSeen) {
  for (std::size_t size = 0; size < sound.size(); ++size) {
    expect_absent(sound.substr(0, size), std::to_string(size) + " bytes left");
  }
}

TEST_F(CacheDamage, EveryFlippedBitIsSeen) {
  for (std::size_t i = 0; i < 8 * sound.size(); ++i) {
    std::string content = sound;
    content[i / 8] = static_cast<char>(content[i / 8] ^ (1 << (i % 8)));
    expect_absent(content, "bit " + std::to_string(i));
  }
}

TEST_F(CacheDamage, BytesAtTheEndAreSeen) {
  expect_absent(sound + '\0', "one more byte");
  expect_absent(sound + sound, "twice");
}

TEST_F(CacheDamage, HugeLengthsAreSeenBeforeMemoryIsTaken) {
  std::string content = sound;
  for (const std::size_t at : {20, 24}) {
    for (std::size_t i = 0; i < 4; ++i) content[at + i] = '\xff';
    expect_absent(content, "length at " + std::to_string(at));
  }
}

TEST_F(CacheDamage, AnEntryOfAnotherKeyIsNotTaken) {
  cache.store("another key", bytes_of("other"));
  const auto other = test::content_of(path_of(cache, "another key"));
  std::filesystem::remove(path_of(cache, "another key"));
  EXPECT_THAT(notes_on(other), ElementsAre(HasSubstr("belongs to something else and is rebuilt")));
  const std::vector<CacheEntry> entries = cache.list();
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_FALSE(entries[0].is_sound);
}

TEST_F(CacheDamage, SaysWhatIsWrong) {
  EXPECT_THAT(notes_on(sound.substr(0, 30)),
              ElementsAre(AllOf(HasSubstr(path.string()),
                                HasSubstr("was damaged (it is too short) and is rebuilt"))));
  EXPECT_THAT(notes_on(sound.substr(0, 60)), ElementsAre(HasSubstr("its end is missing")));
  EXPECT_THAT(notes_on(sound + "x"), ElementsAre(HasSubstr("more follows its end")));
  EXPECT_THAT(notes_on(std::string(100, 'x')), ElementsAre(HasSubstr("is not a cache entry")));
  std::string content = sound;
  content.back() ^= 1;
  EXPECT_THAT(notes_on(content), ElementsAre(HasSubstr("its checksum is wrong")));
  content = sound;
  content[16] = 9;
  EXPECT_THAT(notes_on(content), ElementsAre(HasSubstr("has layout 9, not 1")));
}

TEST_F(CacheDamage, IsReportedOnceAndMended) {
  test::write(path, "nonsense");
  EXPECT_EQ(cache.load(key), std::nullopt);
  EXPECT_EQ(cache.load(key), std::nullopt);
  EXPECT_THAT(cache.take_notes(), testing::SizeIs(1));
  EXPECT_TRUE(cache.store(key, bytes_of(payload)));
  EXPECT_EQ(text_in(cache, key), payload);
  EXPECT_EQ(test::content_of(path), sound);
  EXPECT_THAT(cache.take_notes(), IsEmpty());
}

TEST_F(CacheDamage, PipesAndFoldersInPlaceOfAnEntryAreLeftAlone) {
  std::filesystem::remove(path);
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_EQ(cache.load(key), std::nullopt);
  EXPECT_FALSE(cache.store(key, bytes_of(payload)));
  std::filesystem::remove(path);
  std::filesystem::create_directory(path);
  EXPECT_EQ(cache.load(key), std::nullopt);
  EXPECT_FALSE(cache.store(key, bytes_of(payload)));
  EXPECT_EQ(test::files_in(folder.path()), 1);
}

void expect_useless(Cache& cache) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(cache.load(key), std::nullopt);
    EXPECT_FALSE(cache.store(key + std::to_string(i), bytes_of(payload)));
  }
  EXPECT_THAT(cache.list(), IsEmpty());
  EXPECT_EQ(cache.prune(), 0u);
}

TEST(CacheFolder, ThatIsNoneIsNoError) {
  Cache cache("");
  expect_useless(cache);
  EXPECT_THAT(cache.take_notes(), IsEmpty());
}

TEST(CacheFolder, ThatIsAFileIsOneNote) {
  const test::TemporaryFolder folder;
  test::write(folder.path() / "file", "");
  for (const auto& place : {folder.path() / "file", folder.path() / "file" / "below"}) {
    Cache cache(place);
    expect_useless(cache);
    EXPECT_THAT(cache.take_notes(),
                ElementsAre(AllOf(HasSubstr(place.string()), HasSubstr("Nothing is kept"))));
  }
}

/// The superuser may write everywhere: become nobody for a while.
class Nobody {
 public:
  Nobody() : is_root_(geteuid() == 0), done_(!is_root_ || seteuid(65534) == 0) {}
  ~Nobody() {
    if (is_root_ && seteuid(0) != 0) abort();
  }
  Nobody(const Nobody&) = delete;
  Nobody& operator=(const Nobody&) = delete;
  bool done() const { return done_; }

 private:
  bool is_root_, done_;
};

TEST(CacheFolder, ThatIsReadOnlyIsReadAndOneNote) {
  const test::TemporaryFolder folder;
  Cache(folder.path()).store(key, bytes_of(payload));
  std::filesystem::permissions(folder.path(), std::filesystem::perms{0555});
  {
    const Nobody nobody;
    if (!nobody.done()) GTEST_SKIP() << "the superuser may write everywhere";
    Cache cache(folder.path());
    EXPECT_EQ(text_in(cache, key), payload);
    EXPECT_FALSE(cache.store("b", bytes_of(payload)));
    EXPECT_FALSE(cache.store("c", bytes_of(payload)));
    EXPECT_THAT(cache.take_notes(), ElementsAre(HasSubstr("Permission denied")));
  }
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
}

/// No file may become larger than this, as on a disk that is full.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &old_);
    signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit old_{};
  void (*handler_)(int);
};

TEST_F(CacheDamage, AFullDiskIsOneNoteAndLeavesNothingBehind) {
  {
    const FullDisk full(100);
    EXPECT_FALSE(cache.store(key, std::vector<std::byte>(1000)));
    EXPECT_FALSE(cache.store("b", std::vector<std::byte>(1000)));
  }
  EXPECT_THAT(cache.take_notes(), ElementsAre(HasSubstr("File too large")));
  EXPECT_EQ(test::files_in(folder.path()), 1);
  EXPECT_EQ(text_in(cache, key), payload) << "what was there is still there";
}

}  // namespace
}  // namespace surf::io
