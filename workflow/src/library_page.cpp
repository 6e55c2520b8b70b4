// SPDX-License-Identifier: GPL-3.0-or-later
#include "library_page.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

namespace surf::workflow {

namespace {

// The format of cascades relies on it too.
static_assert(std::endian::native == std::endian::little);

using Header = std::array<std::uint64_t, 2>;
constexpr std::size_t word_bytes = 8, start_bytes = 4;

}  // namespace

std::vector<std::byte> page_to_bytes(const mc::CascadePage& page) {
  const Header header{page.starts.size(), page.words.size()};
  std::vector<std::byte> bytes(sizeof header + word_bytes * page.words.size() +
                               start_bytes * page.starts.size());
  std::byte* at = bytes.data();
  const auto add = [&](const auto& values) {
    const auto part = std::as_bytes(std::span(values));
    at = std::copy(part.begin(), part.end(), at);
  };
  add(header);
  add(page.words);
  add(page.starts);
  return bytes;
}

std::optional<mc::CascadePage> page_from_bytes(std::span<const std::byte> bytes) {
  Header header;
  if (bytes.size() < sizeof header) return std::nullopt;
  std::memcpy(header.data(), bytes.data(), sizeof header);
  bytes = bytes.subspan(sizeof header);
  const auto [starts, words] = header;
  // Compared by division, which cannot overflow.
  if (words > bytes.size() / word_bytes || starts > bytes.size() / start_bytes ||
      words * word_bytes + starts * start_bytes != bytes.size())
    return std::nullopt;
  const auto* const begin_words = bytes.data();
  mc::CascadePage page;
  page.words.resize(words);
  page.starts.resize(starts);
  if (words > 0) std::memcpy(page.words.data(), begin_words, words * word_bytes);
  if (starts > 0)
    std::memcpy(page.starts.data(), begin_words + words * word_bytes, starts * start_bytes);
  return page;
}

}  // namespace surf::workflow
