// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bytes.h"

namespace surf::io {

/// A value in a directory of a TIFF file. A number is returned only if it exists and the value has
/// a numeric type.
class TiffTag {
 public:
  TiffTag(Bytes values, int type, std::size_t count, std::endian order)
      : values_(std::move(values)), type_(type), count_(count), order_(order) {}
  std::size_t count() const { return count_; }
  const Bytes& bytes() const { return values_; }
  std::optional<double> number(std::size_t index = 0) const;
  /// A number that is whole, 0 or above and exact, such as a place or a size.
  std::optional<std::size_t> whole(std::size_t index = 0) const;
  std::string text() const;

 private:
  Bytes values_;
  int type_;
  std::size_t count_;
  std::endian order_;
};

/// A directory of a TIFF file. Instruments store data there that image viewers ignore.
struct TiffPage {
  std::map<int, TiffTag> tags;
  const TiffTag* find(int tag) const;
  std::optional<double> number(int tag) const;
  std::string text(int tag) const;
};

bool is_tiff(std::string_view content);
std::endian tiff_order(std::string_view content);
/// Parses all pages of a TIFF file. Tags whose values do not lie in the file are left out.
std::vector<TiffPage> parse_tiff_pages(const Bytes& bytes);

}  // namespace surf::io
