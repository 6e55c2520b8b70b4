// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "surf/core/grid.h"

namespace surf {

/// Bytes in a nameless file that the system reads and writes as they are used, all zero at first.
/// The file is gone with the object, or with the program, however that ends.
class ScratchMemory {
 public:
  /// Takes `bytes` (> 0) of the disk at once. Throws FileError where they cannot be had.
  ScratchMemory(const std::string& folder, std::size_t bytes);
  ~ScratchMemory();
  ScratchMemory(const ScratchMemory&) = delete;
  ScratchMemory& operator=(const ScratchMemory&) = delete;

  void* data() const { return data_; }

  /// Leaves the content to the disk: it stays, but takes no memory until it is used again.
  void release() const;

 private:
  void* data_ = nullptr;
  std::size_t bytes_;
};

/// A grid as `Grid`, of plain values that are all zero at first, in memory or in a scratch file.
template <class T>
class LargeGrid {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  LargeGrid() = default;

  /// In memory; with the name of a folder, in a scratch file there.
  LargeGrid(int width, int height, const std::string& scratch_folder = {})
      : width_(width), height_(height) {
    if (scratch_folder.empty()) {
      values_.resize(size());
      data_ = values_.data();
    } else {
      scratch_ = std::make_unique<ScratchMemory>(scratch_folder, size() * sizeof(T));
      data_ = static_cast<T*>(scratch_->data());
    }
  }

  /// A copy, in memory.
  LargeGrid(const Grid<T>& grid)
      : width_(grid.width()), height_(grid.height()), values_(grid.data()), data_(values_.data()) {}

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t size() const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  }

  T& operator()(int x, int y) { return data_[index(x, y)]; }
  const T& operator()(int x, int y) const { return data_[index(x, y)]; }

  std::span<T> data() { return {data_, size()}; }
  std::span<const T> data() const { return {data_, size()}; }

  /// See ScratchMemory; nothing where there is no scratch file. Whoever goes through a large grid
  /// calls it now and then.
  void release() const {
    if (scratch_) scratch_->release();
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  int width_ = 0, height_ = 0;
  std::vector<T> values_;  // moving it leaves its elements where they are
  std::unique_ptr<ScratchMemory> scratch_;
  T* data_ = nullptr;
};

}  // namespace surf
