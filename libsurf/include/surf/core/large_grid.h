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

/// Memory that is mapped to a nameless scratch file, all zero at first. The system reads and writes
/// the file on demand. The file disappears with the object, and also when the program ends in any
/// way.
class ScratchMemory {
 public:
  /// Reserves `bytes` (> 0) on the disk. Throws FileError if the disk has no room.
  ScratchMemory(const std::string& folder, std::size_t bytes);
  ~ScratchMemory();
  ScratchMemory(const ScratchMemory&) = delete;
  ScratchMemory& operator=(const ScratchMemory&) = delete;

  void* data() const { return data_; }

  /// Frees the memory. The content stays in the file and is read again on use.
  void release() const;

 private:
  void* data_ = nullptr;
  std::size_t bytes_;
};

/// A grid like `Grid`, for trivially copyable values, in memory or in a scratch file. All values
/// are zero at first.
template <class T>
class LargeGrid {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  LargeGrid() = default;

  /// A grid in memory, or in a scratch file in `scratch_folder` if that is not empty.
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

  /// Calls ScratchMemory::release; does nothing for a grid in memory. Call it now and then while
  /// you traverse a large grid.
  void release() const {
    if (scratch_) scratch_->release();
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  int width_ = 0, height_ = 0;
  std::vector<T> values_;  // a move keeps data_ valid
  std::unique_ptr<ScratchMemory> scratch_;
  T* data_ = nullptr;
};

}  // namespace surf
