// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's entry. Usage: fuzz TARGET[+] [libFuzzer's options] [corpus folders]
// TARGET+ takes what was read through the steps that follow. docs/development/testing.md has more.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "targets.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

using surf::test::Chance;
using surf::test::FuzzTarget;

FuzzTarget target;
bool go_on = false;

/// What became of the inputs. Changes of refused ones are refused again as a rule and teach little
/// about what lies behind the header: most changes start from an input that was read.
class Inputs {
 public:
  ~Inputs() { std::fprintf(stderr, "stat::inputs_read: %zu of %zu\n", read_, given_); }

  void add(const std::string& content, bool read) {
    ++given_;
    read_ += read;
    if (!read) {
      refused_.insert(std::hash<std::string>()(content));
    } else if (kept_.size() < most_kept) {
      kept_.push_back(content);
    } else if (given_ % 16 == 0) {
      kept_[given_ / 16 % most_kept] = content;
    }
  }
  /// The content, or another one that was read.
  std::string_view readable(std::string_view content, std::size_t choice) const {
    constexpr std::size_t nevertheless = 8;  // one in so many
    if (kept_.empty() || choice % nevertheless == 0) return content;
    const bool refused = refused_.contains(std::hash<std::string_view>()(content));
    return refused ? std::string_view(kept_[choice / nevertheless % kept_.size()]) : content;
  }

 private:
  static constexpr std::size_t most_kept = 1024;
  std::size_t given_ = 0, read_ = 0;
  std::unordered_set<std::size_t> refused_;
  std::vector<std::string> kept_;
} inputs;

std::string libfuzzer_bytes(std::string bytes) {
  const std::size_t size = bytes.size();
  bytes.resize(2 * size + 16);
  bytes.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bytes.data()), size, bytes.size()));
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  if (*count < 2) {
    std::fprintf(stderr, "usage: fuzz TARGET[+] [options] [folders]\n");
    std::exit(2);
  }
  std::string name = (*arguments)[1];
  if (name.ends_with('+')) {
    go_on = true;
    name.pop_back();
  }
  try {
    target = surf::test::fuzz_target(name);
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "%s\n", error.what());
    std::exit(2);
  }
  for (int i = 1; i + 1 <= *count; ++i) (*arguments)[i] = (*arguments)[i + 1];
  --*count;
  // No Gwyddion is found, which would be asked about unknown files: its process takes too long.
  return ::setenv("PATH", "", 1);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string content(reinterpret_cast<const char*>(data), size);
  // Pictures in glTF are decoded by OpenImageIO, which takes long and is not instrumented.
  if (content.find("image/png") != std::string::npos) return -1;
  const bool read = surf::test::is_read(target, content, go_on);
  inputs.add(content, read);
  // One in eight of the refused may join the corpus.
  return read || std::hash<std::string>()(content) % 8 == 0 ? 0 : -1;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned int seed) {
  constexpr unsigned int without_form = 16;  // one in so many
  if (seed % without_form == 0) return LLVMFuzzerMutate(data, size, max_size);
  Chance chance(seed, libfuzzer_bytes);
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  const std::string changed =
      target.mutate(inputs.readable(content, chance.below(1 << 20)), chance);
  if (changed.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::memcpy(data, changed.data(), changed.size());
  return changed.size();
}
