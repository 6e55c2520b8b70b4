// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "surf/core/large_pages.h"

namespace surf {

/// A rectangle of samples, row-major. Sample (0, 0) is the lower-left one, x runs right, y runs up;
/// only `io` ever flips rows.
template <class T>
class Grid {
 public:
  Grid() = default;
  Grid(int width, int height, T value = T{}) : width_(width), height_(height) {
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    data_.reserve(count);
    prefer_large_pages(data_.data(), count * sizeof(T));
    data_.resize(count, value);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t size() const { return data_.size(); }
  bool empty() const { return data_.empty(); }

  T& operator()(int x, int y) { return data_[index(x, y)]; }
  const T& operator()(int x, int y) const { return data_[index(x, y)]; }

  std::vector<T>& data() { return data_; }
  const std::vector<T>& data() const { return data_; }

  friend bool operator==(const Grid&, const Grid&) = default;

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  int width_ = 0;
  int height_ = 0;
  std::vector<T> data_;
};

}  // namespace surf
