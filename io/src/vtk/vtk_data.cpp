// SPDX-License-Identifier: GPL-3.0-or-later
// The only source that knows zlib.
#include "vtk_data.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "files/base64.h"

namespace surf::io {
namespace {

/// Bytes from the front of raw or base64 text.
class Source {
 public:
  Source(std::string_view text, bool is_base64) : raw_(text), base64_(text), decode_(is_base64) {}

  std::string take(std::uint64_t bytes) {
    if (bytes > most()) throw BadVtkData("its data is cut off");
    if (decode_) {
      const auto taken = base64_.take(bytes);
      if (!taken) throw BadVtkData("its data is cut off or not base64");
      return *taken;
    }
    std::string taken(raw_.substr(0, bytes));
    raw_.remove_prefix(bytes);
    return taken;
  }
  std::size_t most() const { return decode_ ? base64_.most() : raw_.size(); }

 private:
  std::string_view raw_;
  Base64Reader base64_;
  bool decode_;
};

std::uint64_t bits_at(const char* bytes, std::size_t size, bool big_endian) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t place = big_endian ? size - 1 - i : i;
    bits |= std::uint64_t{static_cast<unsigned char>(bytes[place])} << (8 * i);
  }
  return bits;
}

std::vector<std::uint64_t> take_counts(Source& source, std::uint64_t count,
                                       const VtkEncoding& encoding) {
  const std::size_t size = encoding.long_header ? 8 : 4;
  if (count > source.most() / size) throw BadVtkData("its data is cut off");
  const std::string bytes = source.take(count * size);
  std::vector<std::uint64_t> counts;
  for (std::size_t i = 0; i < count; ++i) {
    counts.push_back(bits_at(bytes.data() + i * size, size, encoding.big_endian));
  }
  return counts;
}

/// zlib makes nothing larger than 1032 times.
std::string inflate_block(const std::string& packed, std::uint64_t bytes) {
  if (bytes / 1032 > packed.size()) throw BadVtkData("a compressed block is damaged");
  std::string block(bytes, '\0');
  uLongf written = static_cast<uLongf>(bytes);
  const int status =
      uncompress(reinterpret_cast<Bytef*>(block.data()), &written,
                 reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size()));
  if (status != Z_OK || written != bytes) throw BadVtkData("a compressed block is damaged");
  return block;
}

/// Blocks: their number, the size of each, the size of the last if it is smaller, packed sizes.
std::string take_compressed(Source& source, const VtkEncoding& encoding) {
  const std::uint64_t blocks = take_counts(source, 1, encoding)[0];
  if (blocks == 0) return {};
  // The header is one piece of base64, so it is taken as a whole.
  const std::vector<std::uint64_t> sizes = take_counts(source, 2, encoding);
  const std::vector<std::uint64_t> packed = take_counts(source, blocks, encoding);
  std::string bytes;
  for (std::uint64_t i = 0; i < blocks; ++i) {
    const bool is_partial = i + 1 == blocks && sizes[1] > 0;
    bytes += inflate_block(source.take(packed[i]), is_partial ? sizes[1] : sizes[0]);
  }
  return bytes;
}

template <class T>
std::vector<double> numbers_as(const std::string& bytes, bool big_endian) {
  if (bytes.size() % sizeof(T) != 0) throw BadVtkData("its data ends within a number");
  std::vector<double> values;
  values.reserve(bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < bytes.size(); i += sizeof(T)) {
    const std::uint64_t bits = bits_at(bytes.data() + i, sizeof(T), big_endian);
    if constexpr (std::is_same_v<T, float>) {
      values.push_back(double{std::bit_cast<float>(static_cast<std::uint32_t>(bits))});
    } else if constexpr (std::is_same_v<T, double>) {
      values.push_back(std::bit_cast<double>(bits));
    } else {
      values.push_back(static_cast<double>(static_cast<T>(bits)));
    }
  }
  return values;
}

}  // namespace

std::string decode_vtk_bytes(std::string_view text, const VtkEncoding& encoding) {
  Source source(text, encoding.data == VtkEncoding::Data::base64);
  if (encoding.compressed) return take_compressed(source, encoding);
  return source.take(take_counts(source, 1, encoding)[0]);
}

std::vector<double> vtk_numbers(const std::string& bytes, const std::string& type,
                                bool big_endian) {
  if (type == "Float32") return numbers_as<float>(bytes, big_endian);
  if (type == "Float64") return numbers_as<double>(bytes, big_endian);
  if (type == "Int8" || type == "String") return numbers_as<std::int8_t>(bytes, big_endian);
  if (type == "UInt8") return numbers_as<std::uint8_t>(bytes, big_endian);
  if (type == "Int16") return numbers_as<std::int16_t>(bytes, big_endian);
  if (type == "UInt16") return numbers_as<std::uint16_t>(bytes, big_endian);
  if (type == "Int32") return numbers_as<std::int32_t>(bytes, big_endian);
  if (type == "UInt32") return numbers_as<std::uint32_t>(bytes, big_endian);
  if (type == "Int64") return numbers_as<std::int64_t>(bytes, big_endian);
  if (type == "UInt64") return numbers_as<std::uint64_t>(bytes, big_endian);
  throw BadVtkData("its type is not known");
}

std::vector<double> vtk_numbers_of_text(std::string_view text) {
  std::vector<double> values;
  const char* position = text.data();
  const char* const end = position + text.size();
  for (;;) {
    while (position < end && static_cast<unsigned char>(*position) <= ' ') ++position;
    if (position == end) return values;
    double value = 0;
    const auto [stop, error] = std::from_chars(position, end, value);
    const bool ends_well = stop == end || static_cast<unsigned char>(*stop) <= ' ';
    if (error == std::errc::invalid_argument || !ends_well) {
      throw BadVtkData("its text is not made of numbers");
    }
    values.push_back(value);
    position = stop;
  }
}

}  // namespace surf::io
