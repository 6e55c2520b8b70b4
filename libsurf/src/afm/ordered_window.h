// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace surf {

/// A set of different numbers in [0, size) that finds its k-th smallest quickly if it changes
/// little between queries. It keeps a bit for each number, counts by block, and a position that
/// follows the answer (the running median of Huang, Yang and Tang 1979,
/// doi:10.1109/TASSP.1979.1163188, over ranks instead of grey levels).
class OrderedWindow {
 public:
  explicit OrderedWindow(std::size_t size);

  void add(std::uint32_t rank) { change(rank, 1); }      // must not be in the set
  void remove(std::uint32_t rank) { change(rank, -1); }  // must be in the set
  std::size_t size() const { return total_; }

  /// The k-th smallest number, k in [0, size()).
  std::uint32_t kth(std::size_t k);

 private:
  static constexpr std::size_t block_bits = 512;

  void change(std::uint32_t rank, int sign) {
    bits_[rank / 64] ^= std::uint64_t{1} << (rank % 64);
    const std::size_t block = rank / block_bits;
    counts_[block] += sign;
    if (block < at_) below_ += sign;
    total_ += static_cast<std::size_t>(sign);
  }

  std::vector<std::uint64_t> bits_;
  std::vector<int> counts_;
  std::size_t at_ = 0;        // the block of the last answer
  std::ptrdiff_t below_ = 0;  // how many numbers are in the blocks before it
  std::size_t total_ = 0;
};

}  // namespace surf
