// SPDX-License-Identifier: GPL-3.0-or-later
#include "deflate.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <new>

namespace surf::io {
namespace {

// zlib counts in 32 bits: larger input goes in pieces.
constexpr std::size_t piece = std::size_t{1} << 30;

}  // namespace

std::string deflate(std::string_view bytes) {
  z_stream stream{};
  if (deflateInit(&stream, Z_DEFAULT_COMPRESSION) != Z_OK) throw std::bad_alloc();
  std::string result;
  std::array<unsigned char, 65536> out;
  do {
    const std::string_view now = bytes.substr(0, piece);
    bytes.remove_prefix(now.size());
    stream.next_in = const_cast<Bytef*>(
        reinterpret_cast<const Bytef*>(now.data()));  // zlib does not write there
    stream.avail_in = static_cast<uInt>(now.size());
    do {
      stream.next_out = out.data();
      stream.avail_out = static_cast<uInt>(out.size());
      ::deflate(&stream, bytes.empty() ? Z_FINISH : Z_NO_FLUSH);
      result.append(reinterpret_cast<const char*>(out.data()), out.size() - stream.avail_out);
    } while (stream.avail_out == 0);
  } while (!bytes.empty());
  deflateEnd(&stream);
  return result;
}

}  // namespace surf::io
