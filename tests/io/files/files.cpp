// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/files.h"

#include <sys/stat.h>
#include <unistd.h>

#include "io_test.h"

namespace surf::io {
namespace {

using test::complaint;
using test::content_of;
using test::files_in;
using test::write;
using testing::HasSubstr;

TEST(Files, ReadsTheWholeFile) {
  const test::TemporaryFolder folder;
  const std::string content("a\0b\r\n\xff", 6);
  EXPECT_EQ(read_file(write(folder.path() / "a", content)), content);
  EXPECT_EQ(read_file(write(folder.path() / "empty", "")), "");
  EXPECT_EQ(read_file(write(folder.path() / "six", content), 6), content);
  const std::string large(300'000, 'x');
  EXPECT_EQ(read_file(write(folder.path() / "large", large)), large);
}

TEST(Files, SaysWhyAFileCannotBeRead) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(complaint<FileError>([&] { read_file(folder.path() / "none"); }),
              HasSubstr("no such file"));
  EXPECT_THAT(complaint<FileError>([&] { read_file(folder.path()); }), HasSubstr("folder"));
  write(folder.path() / "six", "123456");
  EXPECT_THAT(complaint<FileError>([&] { read_file(folder.path() / "six", 5); }),
              HasSubstr("more than 5 bytes"));
  std::filesystem::create_symlink("loop", folder.path() / "loop");
  EXPECT_THAT(complaint<FileError>([&] { read_file(folder.path() / "loop"); }),
              HasSubstr("cannot be found"));
}

TEST(Files, DevicesAndNamedPipesAreRefusedAtOnce) {
  const test::TemporaryFolder folder;
  const auto pipe = folder.path() / "pipe.stl", link = folder.path() / "zero.gsf";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/zero", link);
  for (const auto& path : {pipe, link, std::filesystem::path("/dev/zero")}) {
    const char* const kind = path == pipe ? "named pipe" : "device";
    EXPECT_THAT(complaint<FileError>([&] { read_file(path); }), HasSubstr(kind));
    EXPECT_THAT(complaint<FileError>([&] { sha256_of_file(path); }), HasSubstr(kind));
    EXPECT_THAT(complaint<FileError>([&] { require_regular_file(path); }), HasSubstr(kind));
  }
}

TEST(Files, TheSizeIsJudgedBeforeMemoryIsTaken) {
  const test::TemporaryFolder folder;
  const auto path = write(folder.path() / "sparse", "");
  std::filesystem::resize_file(path, std::uintmax_t{1} << 40);  // it takes no room on the disk
  EXPECT_THAT(complaint<FileError>([&] { read_file(path); }), HasSubstr("has more than 8.59 GB"));
}

TEST(Files, APipeWithoutANameIsReadOnceAndItsHashIsKept) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const std::filesystem::path path = "/dev/fd/" + std::to_string(ends[0]);
  EXPECT_THAT(complaint<FileError>([&] { require_regular_file(path); }), HasSubstr("a pipe"));
  EXPECT_THAT(complaint<FileError>([&] { sha256_of_file(path); }), HasSubstr("a pipe"));
  ASSERT_EQ(::write(ends[1], "abc", 3), 3);
  ::close(ends[1]);
  EXPECT_EQ(read_file(path), "abc");
  EXPECT_THAT(complaint<FileError>([&] { read_file(path); }), HasSubstr("needed more than once"));
  EXPECT_EQ(sha256_of_file(path),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  ::close(ends[0]);
}

TEST(Files, APipeMayNotBeEndless) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  ASSERT_EQ(::write(ends[1], "123456", 6), 6);
  ::close(ends[1]);
  EXPECT_THAT(complaint<FileError>([&] { read_file("/dev/fd/" + std::to_string(ends[0]), 5); }),
              HasSubstr("more than 5 bytes"));
  ::close(ends[0]);
}

TEST(Files, WritesThroughATemporaryInTheSameFolder) {
  const test::TemporaryFolder folder;
  const auto target = folder.path() / "new" / "deep" / "a.txt";
  write_atomically(target, [&](const std::filesystem::path& temporary) {
    EXPECT_NE(temporary, target);
    EXPECT_EQ(temporary.parent_path(), target.parent_path());
    EXPECT_FALSE(std::filesystem::exists(target));
    write(temporary, "text");
  });
  EXPECT_EQ(content_of(target), "text");
  EXPECT_EQ(files_in(target.parent_path()), 1);
}

TEST(Files, AFailedWriteLeavesTheOldFileAndNothingElse) {
  const test::TemporaryFolder folder;
  const auto target = write(folder.path() / "a.txt", "old");
  const auto fail = [](const std::filesystem::path& temporary) {
    write(temporary, "half");
    throw std::runtime_error("the disk is full");
  };
  EXPECT_THAT(complaint<FileError>([&] { write_atomically(target, fail); }),
              HasSubstr("the disk is full"));
  EXPECT_EQ(content_of(target), "old");
  EXPECT_EQ(files_in(folder.path()), 1);
}

TEST(Files, KeepsLinksAndPermissionsAsUsual) {
  const test::TemporaryFolder folder;
  write(folder.path() / "real", "old");
  std::filesystem::create_symlink("real", folder.path() / "link");
  const mode_t mask = umask(027);
  write_text(folder.path() / "link", "new");
  write_text(folder.path() / "other", "new");
  umask(mask);
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "link"));
  EXPECT_EQ(content_of(folder.path() / "real"), "new");
  EXPECT_EQ(static_cast<int>(std::filesystem::status(folder.path() / "other").permissions()), 0640);
}

TEST(Files, RefusesTargetsThatCannotBeWritten) {
  const test::TemporaryFolder folder;
  write(folder.path() / "file", "");
  ASSERT_EQ(mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
  for (const auto& target :
       {folder.path(), folder.path() / "file" / "below", folder.path() / "pipe",
        std::filesystem::path(""), folder.path() / "new" / "",
        folder.path() / std::string(300, 'n') / "a"}) {
    EXPECT_FALSE(complaint<FileError>([&] { check_writable(target); }).empty()) << target;
    EXPECT_FALSE(complaint<FileError>([&] { write_text(target, "x"); }).empty()) << target;
  }
  EXPECT_EQ(files_in(folder.path()), 2);
}

TEST(Files, RefusesFoldersWithoutPermission) {
  if (geteuid() == 0) GTEST_SKIP() << "the superuser may write everywhere";
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "locked");
  std::filesystem::permissions(folder.path() / "locked", std::filesystem::perms::owner_read);
  complaint<FileError>([&] { check_writable(folder.path() / "locked" / "a"); });
  std::filesystem::permissions(folder.path() / "locked", std::filesystem::perms::owner_all);
}

TEST(Files, CheckingLeavesNothingBehind) {
  const test::TemporaryFolder folder;
  check_writable(folder.path() / "new" / "a.txt");
  EXPECT_EQ(files_in(folder.path() / "new"), 0);
}

TEST(Files, HashesAsSha256sumDoes) {
  const std::string abc = "abc";
  const std::string expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
  EXPECT_EQ(sha256_of(std::as_bytes(std::span(abc))), expected);
  EXPECT_EQ(sha256_of({}), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  const test::TemporaryFolder folder;
  EXPECT_EQ(sha256_of_file(write(folder.path() / "abc", abc)), expected);
  EXPECT_FALSE(complaint<FileError>([&] { sha256_of_file(folder.path() / "none"); }).empty());
  // One million times "a", from the standard (FIPS 180-2).
  EXPECT_EQ(sha256_of_file(write(folder.path() / "million", std::string(1'000'000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

}  // namespace
}  // namespace surf::io
