// SPDX-License-Identifier: GPL-3.0-or-later
#include "afm/ordered_window.h"

#include <bit>

namespace surf {

OrderedWindow::OrderedWindow(std::size_t size)
    : bits_((size / block_bits + 1) * (block_bits / 64)), counts_(size / block_bits + 1) {}

std::uint32_t OrderedWindow::kth(std::size_t k) {
  const auto rank = static_cast<std::ptrdiff_t>(k);
  while (rank < below_) below_ -= counts_[--at_];
  while (rank >= below_ + counts_[at_]) below_ += counts_[at_++];
  auto left = static_cast<int>(rank - below_);
  std::size_t word = at_ * (block_bits / 64);
  for (int inside; left >= (inside = std::popcount(bits_[word])); ++word) left -= inside;
  std::uint64_t bits = bits_[word];
  for (; left > 0; --left) bits &= bits - 1;
  return static_cast<std::uint32_t>(word * 64) + static_cast<std::uint32_t>(std::countr_zero(bits));
}

}  // namespace surf
