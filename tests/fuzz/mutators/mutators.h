// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <string_view>

namespace surf::test {

/// The random choices of a mutator. Equal seeds give equal choices.
class Chance {
 public:
  /// Changes bytes without knowing what they are; libFuzzer's own mutator, or a few random bytes.
  using ChangeBytes = std::function<std::string(std::string bytes)>;

  explicit Chance(std::uint32_t seed, ChangeBytes change_bytes = {})
      : random_(seed), change_bytes_(std::move(change_bytes)) {}

  /// A number from 0 to `count` - 1; 0 if `count` is 0.
  std::size_t below(std::size_t count) { return count > 0 ? random_() % count : 0; }
  bool one_in(std::size_t count) { return below(count) == 0; }
  std::string change_bytes(std::string bytes);

 private:
  std::mt19937 random_;
  ChangeBytes change_bytes_;
};

/// Returns the content with a small change.
using Mutator = std::string (*)(std::string_view content, Chance& chance);

// Text. Mostly numbers change; base64 is decoded for a change of its bytes.
std::string mutate_text(std::string_view content, Chance& chance);
/// The same without changes of lines, for formats that count them.
std::string mutate_counted_text(std::string_view content, Chance& chance);
/// The same with numbers that JSON allows.
std::string mutate_json(std::string_view content, Chance& chance);

// Bytes.
/// Overwrites a number of one to eight bytes; the size stays.
std::string mutate_numbers(std::string_view content, Chance& chance);

// Formats. Each changes a part and mends what depends on it: counts, sizes, checksums.
std::string mutate_stl(std::string_view content, Chance& chance);
std::string mutate_ply(std::string_view content, Chance& chance);
std::string mutate_glb(std::string_view content, Chance& chance);
/// The parts of a ZIP archive change as text.
std::string mutate_zip(std::string_view content, Chance& chance);
std::string mutate_gsf(std::string_view content, Chance& chance);
std::string mutate_gwy(std::string_view content, Chance& chance);
std::string mutate_ibw(std::string_view content, Chance& chance);
/// A text header with the offset of its samples: the header keeps its size.
std::string mutate_nanoscope(std::string_view content, Chance& chance);
std::string mutate_wsxm(std::string_view content, Chance& chance);
/// A text header that ends with a mark.
std::string mutate_nid(std::string_view content, Chance& chance);
std::string mutate_sxm(std::string_view content, Chance& chance);
std::string mutate_cache_entry(std::string_view content, Chance& chance);
std::string mutate_checkpoint(std::string_view content, Chance& chance);

}  // namespace surf::test
