// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/random.h"

#include <Random123/philox.h>

#include <stdexcept>

namespace surf {

std::array<std::uint32_t, 4> random_block(const std::array<std::uint32_t, 2>& key,
                                          const std::array<std::uint32_t, 4>& counter) {
  const auto block = r123::Philox4x32_R<7>{}({{counter[0], counter[1], counter[2], counter[3]}},
                                             {{key[0], key[1]}});
  return {block[0], block[1], block[2], block[3]};
}

RandomStream::RandomStream(std::uint64_t seed, std::uint64_t pixel, std::uint64_t electron) {
  constexpr std::uint64_t limit = std::uint64_t{1} << 48;
  if (pixel >= limit || electron >= limit)
    throw std::out_of_range("RandomStream: pixel and electron must be below 2^48");
  key_[0] = static_cast<std::uint32_t>(seed);
  key_[1] = static_cast<std::uint32_t>(seed >> 32);
  counter_[0] = static_cast<std::uint32_t>(electron);
  counter_[1] = static_cast<std::uint32_t>(pixel);
  counter_[2] =
      static_cast<std::uint32_t>(pixel >> 32) << 16 | static_cast<std::uint32_t>(electron >> 32);
}

void RandomStream::refill() {
  const r123::Philox4x32::key_type key{{key_[0], key_[1]}};
  for (int i = 0; i < buffer_words; i += 4) {
    const r123::Philox4x32::ctr_type block =
        r123::Philox4x32{}({{block_++, counter_[0], counter_[1], counter_[2]}}, key);
    for (int k = 0; k < 4; ++k) buffer_[i + k] = block[static_cast<std::size_t>(k)];
  }
  next_ = 0;
}

}  // namespace surf
