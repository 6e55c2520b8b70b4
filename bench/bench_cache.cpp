// SPDX-License-Identifier: GPL-3.0-or-later
// How fast a cache stores and loads, beside the floor: reading the file, SHA-256 of the payload.
//   bench_cache [megabytes, default 500] [folder, default the current one]
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "surf/io/cache.h"
#include "surf/io/files.h"

namespace {

template <class Work>
void report(const char* name, double megabytes, const Work& work) {
  double best = 1e9;
  for (int i = 0; i < 3; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const auto end = std::chrono::steady_clock::now();
    best = std::min(best, std::chrono::duration<double>(end - start).count());
  }
  fmt::print("{:28} {:7.3f} s {:7.2f} GB/s\n", name, best, megabytes / 1000 / best);
}

}  // namespace

int main(int argc, char** argv) {
  const double megabytes = argc > 1 ? std::atof(argv[1]) : 500;
  const std::filesystem::path folder =
      std::filesystem::path(argc > 2 ? argv[2] : ".") / "bench_cache.tmp";
  std::vector<std::byte> payload(static_cast<std::size_t>(megabytes * 1e6));
  for (std::size_t i = 0; i < payload.size(); ++i) payload[i] = static_cast<std::byte>(i * i >> 7);

  surf::io::Cache cache(folder);
  report("store (with fsync)", megabytes, [&] { cache.store("bench", payload); });
  report("load", megabytes, [&] { cache.load("bench"); });
  report("check all entries", megabytes, [&] { cache.list(surf::io::Cache::Check::everything); });
  const auto path = cache.list().at(0).path;
  report("floor: read the file", megabytes, [&] { surf::io::read_file(path); });
  report("instead: SHA-256 of it", megabytes, [&] { surf::io::sha256_of(payload); });
  std::filesystem::remove_all(folder);
}
