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

/// A value of a TIFF file's directory. Numbers are read where they are there and of a kind of
/// number.
class TiffTag {
 public:
  TiffTag(Bytes values, int type, std::size_t count, std::endian order)
      : values_(std::move(values)), type_(type), count_(count), order_(order) {}
  std::size_t count() const { return count_; }
  const Bytes& bytes() const { return values_; }
  std::optional<double> number(std::size_t index = 0) const;
  std::string text() const;

 private:
  Bytes values_;
  int type_;
  std::size_t count_;
  std::endian order_;
};

/// The directories of a TIFF file, as instruments use them to keep what no image viewer knows.
struct TiffPage {
  std::map<int, TiffTag> tags;
  const TiffTag* find(int tag) const;
  std::optional<double> number(int tag) const;
  std::string text(int tag) const;
};

bool is_tiff(std::string_view content);
std::endian tiff_order(std::string_view content);
/// All pages of a TIFF file; tags whose values do not lie in the file are left out.
std::vector<TiffPage> parse_tiff_pages(const Bytes& bytes);

}  // namespace surf::io
