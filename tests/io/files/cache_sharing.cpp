// SPDX-License-Identifier: GPL-3.0-or-later
// Processes and threads that use, write and remove the same entries at once.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "cache_test.h"

namespace surf::io {
namespace {

using test::bytes_of;
using test::text_in;

constexpr std::size_t payload_size = 100'000;

/// Writes and reads one entry over and over: what is read is always one writer's whole payload.
bool hammer(const std::filesystem::path& folder, int writer, int rounds) {
  Cache cache(folder);
  const std::vector<std::byte> mine(payload_size, static_cast<std::byte>(writer));
  for (int i = 0; i < rounds; ++i) {
    if (!cache.store("shared", mine)) return false;
    const auto read = cache.load("shared");
    if (!read || read->size() != payload_size) return false;
    if (std::count(read->begin(), read->end(), read->front()) !=
        static_cast<std::ptrdiff_t>(payload_size))
      return false;
  }
  return cache.take_notes().empty();
}

/// Runs the work in a process of its own.
template <class Work>
pid_t start(const Work& work) {
  const pid_t child = fork();
  if (child == 0) _exit(work() ? 0 : 1);
  return child;
}

bool succeeded(pid_t child) {
  int status = 0;
  return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST(CacheSharing, ProcessesWriteTheSameEntryAtOnce) {
  const test::TemporaryFolder folder;
  std::vector<pid_t> children;
  for (int writer = 0; writer < 4; ++writer) {
    children.push_back(start([&] { return hammer(folder.path(), writer, 25); }));
  }
  for (const pid_t child : children) EXPECT_TRUE(succeeded(child));
  EXPECT_EQ(test::files_in(folder.path()), 1);
}

TEST(CacheSharing, ThreadsShareOneCache) {
  const test::TemporaryFolder folder;
  Cache cache(folder.path());
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (int writer = 0; writer < 4; ++writer) {
    threads.emplace_back([&, writer] {
      for (int i = 0; i < 25; ++i) {
        const std::string key = "entry " + std::to_string((writer + i) % 3);
        cache.store(key, bytes_of(key));
        if (text_in(cache, key) != key) ++wrong;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(cache.list(Cache::Check::everything).size(), 3u);
}

TEST(CacheSharing, WhatAnotherProcessUsesIsNotPruned) {
  const test::TemporaryFolder folder;
  Cache(folder.path()).store("theirs", bytes_of("x"));
  Cache(folder.path()).store("nobody's", bytes_of("x"));
  int ready[2], done[2];
  ASSERT_EQ(pipe(ready), 0);
  ASSERT_EQ(pipe(done), 0);
  const pid_t child = start([&] {
    close(done[1]);
    Cache cache(folder.path());
    char byte = 'x';
    return cache.load("theirs") && write(ready[1], &byte, 1) == 1 && read(done[0], &byte, 1) == 0;
  });
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  Cache cache(folder.path(), 0);
  cache.prune();
  ASSERT_EQ(cache.list().size(), 1u);
  EXPECT_EQ(cache.list()[0].key, "theirs");
  close(done[1]);  // the child ends
  EXPECT_TRUE(succeeded(child));
  for (const int end : {ready[0], ready[1], done[0]}) close(end);
  cache.prune();
  EXPECT_EQ(cache.list().size(), 0u);
}

TEST(CacheSharing, MoreEntriesThanLocksAreNoProblem) {
  const test::TemporaryFolder folder;
  Cache cache(folder.path(), 0x10000);
  for (int i = 0; i < 100; ++i) cache.store(std::to_string(i), std::vector<std::byte>(1000));
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(cache.load(std::to_string(i))) << "own ones are spared";
}

}  // namespace
}  // namespace surf::io
