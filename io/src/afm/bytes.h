// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace surf::io {

/// The bytes of a scan file, or of a part of it. Nothing outside is ever read: each access beyond
/// the part is a FileError that names the file and the byte.
class Bytes {
 public:
  Bytes(std::string file, std::string_view data, std::size_t first = 0)
      : file_(std::move(file)), data_(data), first_(first) {}

  std::size_t size() const { return data_.size(); }
  std::string_view text() const { return data_; }
  const std::string& file() const { return file_; }

  Bytes part(std::size_t offset, std::size_t size) const {
    require(offset, size);
    return {file_, data_.substr(offset, size), first_ + offset};
  }

  template <class T>
  T little(std::size_t offset) const {
    return number<T>(offset, std::endian::little);
  }
  template <class T>
  T big(std::size_t offset) const {
    return number<T>(offset, std::endian::big);
  }
  template <class T>
  T number(std::size_t offset, std::endian order) const {
    static_assert(std::is_arithmetic_v<T>);
    require(offset, sizeof(T));
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, data_.data() + offset, sizeof(T));
    if (order != std::endian::native && sizeof(T) > 1)
      for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }

  /// Text of at most `size` bytes, up to its first NUL.
  std::string_view fixed_text(std::size_t offset, std::size_t size) const;

  void require(std::size_t offset, std::size_t size) const {
    if (offset > data_.size() || size > data_.size() - offset) fail_short(offset, size);
  }
  [[noreturn]] void fail(const std::string& reason, const std::string& remedy = {}) const;

 private:
  [[noreturn]] void fail_short(std::size_t offset, std::size_t size) const;

  std::string file_;
  std::string_view data_;
  std::size_t first_;  ///< offset of the part in the file, for messages
};

}  // namespace surf::io
