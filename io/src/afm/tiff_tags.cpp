// SPDX-License-Identifier: GPL-3.0-or-later
#include "tiff_tags.h"

#include <array>
#include <cmath>
#include <set>

#include "scan.h"

namespace surf::io {
namespace {

std::size_t bytes_of_type(int type) {
  constexpr std::array<std::size_t, 14> sizes{0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4};
  return type > 0 && type < int(sizes.size()) ? sizes[std::size_t(type)] : 0;
}

}  // namespace

std::optional<double> TiffTag::number(std::size_t index) const {
  if (index >= count_) return std::nullopt;
  const std::size_t at = index * bytes_of_type(type_);
  switch (type_) {
    case 1:
      return values_.number<std::uint8_t>(at, order_);
    case 3:
      return values_.number<std::uint16_t>(at, order_);
    case 4:
      return values_.number<std::uint32_t>(at, order_);
    case 5: {
      const double above = values_.number<std::uint32_t>(at, order_),
                   below = values_.number<std::uint32_t>(at + 4, order_);
      return below > 0 ? std::optional(above / below) : std::nullopt;
    }
    case 6:
      return values_.number<std::int8_t>(at, order_);
    case 8:
      return values_.number<std::int16_t>(at, order_);
    case 9:
      return values_.number<std::int32_t>(at, order_);
    case 11:
      return double{values_.number<float>(at, order_)};
    case 12:
      return values_.number<double>(at, order_);
    default:
      return std::nullopt;
  }
}

std::optional<std::size_t> TiffTag::whole(std::size_t index) const {
  constexpr double most = 0x1p53;
  const auto value = number(index);
  if (!value || !(*value >= 0 && *value <= most) || *value != std::floor(*value))
    return std::nullopt;
  return static_cast<std::size_t>(*value);
}

std::string TiffTag::text() const { return clean_text(values_.fixed_text(0, values_.size())); }

const TiffTag* TiffPage::find(int tag) const {
  const auto found = tags.find(tag);
  return found == tags.end() ? nullptr : &found->second;
}
std::optional<double> TiffPage::number(int tag) const {
  const TiffTag* const found = find(tag);
  return found ? found->number() : std::nullopt;
}
std::string TiffPage::text(int tag) const {
  const TiffTag* const found = find(tag);
  return found ? found->text() : std::string{};
}

bool is_tiff(std::string_view content) {
  using namespace std::string_view_literals;
  return content.starts_with("II\x2A\0"sv) || content.starts_with("MM\0\x2A"sv);
}

std::endian tiff_order(std::string_view content) {
  return content.starts_with("II") ? std::endian::little : std::endian::big;
}

std::vector<TiffPage> parse_tiff_pages(const Bytes& bytes) {
  constexpr std::size_t most_pages = 4096, entry_bytes = 12, inline_bytes = 4;
  const std::endian order = tiff_order(bytes.text());
  std::vector<TiffPage> pages;
  std::set<std::size_t> seen;  // a damaged file may run in circles
  for (std::size_t at = bytes.number<std::uint32_t>(4, order); at != 0 && seen.insert(at).second;) {
    if (pages.size() == most_pages) bytes.fail("it has too many pages");
    TiffPage& page = pages.emplace_back();
    const std::size_t entries = bytes.number<std::uint16_t>(at, order);
    bytes.require(at + 2, entries * entry_bytes + 4);
    for (std::size_t i = 0; i < entries; ++i) {
      const std::size_t entry = at + 2 + i * entry_bytes;
      const int type = bytes.number<std::uint16_t>(entry + 2, order);
      const std::size_t count = bytes.number<std::uint32_t>(entry + 4, order);
      const std::size_t size = count * bytes_of_type(type);
      const std::size_t place =
          size > inline_bytes ? bytes.number<std::uint32_t>(entry + 8, order) : entry + 8;
      if (size == 0 || place > bytes.size() || size > bytes.size() - place) continue;
      page.tags.emplace(bytes.number<std::uint16_t>(entry, order),
                        TiffTag(bytes.part(place, size), type, count, order));
    }
    at = bytes.number<std::uint32_t>(at + 2 + entries * entry_bytes, order);
  }
  return pages;
}

}  // namespace surf::io
