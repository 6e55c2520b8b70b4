// SPDX-License-Identifier: GPL-3.0-or-later
#include "bytes.h"

#include <fmt/format.h>

#include <algorithm>

#include "files/damaged.h"
#include "surf/core/error.h"

namespace surf::io {

std::string_view Bytes::fixed_text(std::size_t offset, std::size_t size) const {
  require(offset, size);
  const std::string_view all = data_.substr(offset, size);
  return all.substr(0, std::min(all.find('\0'), all.size()));
}

void Bytes::fail(const std::string& reason, const std::string& remedy) const {
  throw FileError(file_, reason, remedy.empty() ? copy_again : remedy);
}

void Bytes::fail_short(std::size_t offset, std::size_t size) const {
  throw FileError(fmt::format("{}, byte {}", file_, first_ + offset),
                  fmt::format("{} bytes should follow here, and there are {}", size,
                              offset > data_.size() ? 0 : data_.size() - offset),
                  copy_again);
}

}  // namespace surf::io
