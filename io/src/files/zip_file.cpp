// SPDX-License-Identifier: GPL-3.0-or-later
#include "zip_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>

#include "damaged.h"
#include "surf/core/error.h"
#include "text_scanner.h"

namespace surf::io {
namespace {

constexpr std::uint32_t part_mark = 0x04034b50, entry_mark = 0x02014b50, end_mark = 0x06054b50,
                        large_end_mark = 0x06064b50;
constexpr std::size_t end_bytes = 22;
constexpr std::uint64_t utf8_flag = 0x800;
constexpr std::uint64_t packed_method = 8;
constexpr std::uint64_t first_day = 0x21;  // 1980-01-01, the least that the format can say
constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();

std::string bytes_of(std::initializer_list<std::pair<std::uint64_t, int>> fields) {
  std::string bytes;
  for (const auto& [value, size] : fields) {
    for (int i = 0; i < size; ++i) bytes.push_back(static_cast<char>(value >> (8 * i) & 0xff));
  }
  return bytes;
}

Bytef* zlib_bytes(std::string_view text) {
  return reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return result;
}

}  // namespace

struct ZipWriter::Part {
  std::string name;
  std::uint64_t offset = 0, packed = 0, size = 0;
  std::uint32_t checksum = 0;

  /// The fields that local and central headers share.
  std::string fields() const {
    return bytes_of({{20, 2},
                     {utf8_flag, 2},
                     {packed_method, 2},
                     {0, 2},
                     {first_day, 2},
                     {checksum, 4},
                     {packed, 4},
                     {size, 4},
                     {name.size(), 2},
                     {0, 2}});
  }
};

struct ZipWriter::Packer {
  z_stream stream{};
  std::array<Bytef, std::size_t{1} << 16> buffer;

  Packer() {
    // Level 1 takes a third of the time of the default, for files a fifth larger; -15: without
    // zlib's own header.
    if (deflateInit2(&stream, 1, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY) != Z_OK)
      throw std::bad_alloc();
  }
  ~Packer() { deflateEnd(&stream); }
};

ZipWriter::ZipWriter(std::string file) : file_(std::move(file)) {}
ZipWriter::~ZipWriter() = default;

void ZipWriter::begin(const std::string& name) {
  end_part();
  parts_.push_back({name, content_.size(), 0, 0, static_cast<std::uint32_t>(crc32(0, nullptr, 0))});
  content_ += bytes_of({{part_mark, 4}}) + parts_.back().fields() + name;  // filled in by end_part
  packer_ = std::make_unique<Packer>();
}

void ZipWriter::append(std::string_view piece) {
  Part& part = parts_.back();
  part.size += piece.size();
  part.checksum =
      static_cast<std::uint32_t>(crc32_z(part.checksum, zlib_bytes(piece), piece.size()));
  constexpr std::size_t step = std::size_t{1} << 30;  // zlib counts in 32 bits
  for (; !piece.empty(); piece.remove_prefix(std::min(step, piece.size())))
    pack(piece.substr(0, step), false);
}

void ZipWriter::pack(std::string_view piece, bool is_last) {
  z_stream& stream = packer_->stream;
  stream.next_in = zlib_bytes(piece);
  stream.avail_in = static_cast<uInt>(piece.size());
  do {
    stream.next_out = packer_->buffer.data();
    stream.avail_out = static_cast<uInt>(packer_->buffer.size());
    deflate(&stream, is_last ? Z_FINISH : Z_NO_FLUSH);
    const std::size_t made = packer_->buffer.size() - stream.avail_out;
    content_.append(reinterpret_cast<const char*>(packer_->buffer.data()), made);
    parts_.back().packed += made;
  } while (stream.avail_out == 0);
}

void ZipWriter::end_part() {
  if (!packer_) return;
  pack({}, true);
  packer_.reset();
  const Part& part = parts_.back();
  if (part.size > most || part.packed > most || content_.size() > most) {
    throw InvalidInput(file_, "it would have more than the 4 GB that its archive can count",
                       "Simplify the surface, or write another format");
  }
  const std::string fields = part.fields();
  content_.replace(part.offset + 4, fields.size(), fields);
}

std::string ZipWriter::finish() {
  end_part();
  const std::uint64_t start = content_.size();
  for (const Part& part : parts_) {
    content_ += bytes_of({{entry_mark, 4}, {20, 2}}) + part.fields() +
                bytes_of({{0, 2}, {0, 2}, {0, 2}, {0, 4}, {part.offset, 4}}) + part.name;
  }
  content_ += bytes_of({{end_mark, 4},
                        {0, 2},
                        {0, 2},
                        {parts_.size(), 2},
                        {parts_.size(), 2},
                        {content_.size() - start, 4},
                        {start, 4},
                        {0, 2}});
  return std::move(content_);
}

ZipReader::ZipReader(std::string file, std::string_view content)
    : file_(std::move(file)), content_(content) {
  // The end has a comment of up to 65535 bytes behind it.
  const std::size_t last = content.size() < end_bytes ? 0 : content.size() - end_bytes;
  const std::size_t first = last > 65535 ? last - 65535 : 0;
  for (std::size_t at = last + 1; content.size() >= end_bytes && at-- > first;) {
    if (number(at, 4) != end_mark) continue;
    std::uint64_t entries = number(at + 10, 2), start = number(at + 16, 4);
    if (start == most && at >= 20) {  // counts of 64 bits lie before it
      const std::uint64_t large = number(at - 12, 8);
      if (number(large, 4) != large_end_mark) fail("its directory is not where it should be");
      entries = number(large + 32, 8);
      start = number(large + 48, 8);
    }
    read_directory(start, entries);
    return;
  }
  fail("the end of its archive is missing");
}

void ZipReader::fail(const std::string& reason) const {
  throw FileError(file_, reason, copy_again);
}

std::uint64_t ZipReader::number(std::uint64_t position, int bytes) const {
  const auto size = static_cast<std::uint64_t>(bytes);
  if (position > content_.size() || content_.size() - position < size)
    fail("its archive ends too early");
  std::uint64_t value = 0;
  for (std::uint64_t i = 0; i < size; ++i) {
    value |= std::uint64_t{static_cast<unsigned char>(content_[position + i])} << (8 * i);
  }
  return value;
}

void ZipReader::read_directory(std::uint64_t position, std::uint64_t entries) {
  for (std::uint64_t i = 0; i < entries; ++i) {
    if (number(position, 4) != entry_mark) fail("the directory of its archive is damaged");
    Entry entry;
    entry.flags = static_cast<std::uint32_t>(number(position + 8, 2));
    entry.method = static_cast<std::uint32_t>(number(position + 10, 2));
    entry.checksum = static_cast<std::uint32_t>(number(position + 16, 4));
    entry.packed = number(position + 20, 4);
    entry.size = number(position + 24, 4);
    entry.offset = number(position + 42, 4);
    const std::uint64_t name = number(position + 28, 2), more = number(position + 30, 2),
                        comment = number(position + 32, 2);
    const std::uint64_t behind = position + 46 + name;
    number(behind + more, 0);  // they end within the file
    entry.name = content_.substr(position + 46, name);
    apply_large(entry, behind, behind + more);
    entries_.push_back(std::move(entry));
    position = behind + more + comment;
  }
}

/// Numbers of 64 bits that replace those of 32 bits which are at their limit.
void ZipReader::apply_large(Entry& entry, std::uint64_t position, std::uint64_t end) const {
  while (position + 4 <= end) {
    const std::uint64_t kind = number(position, 2), size = number(position + 2, 2);
    position += 4;
    if (kind == 1) {
      std::uint64_t at = position;
      for (std::uint64_t* value : {&entry.size, &entry.packed, &entry.offset}) {
        if (*value != most) continue;
        *value = number(at, 8);
        at += 8;
      }
      return;
    }
    position += size;
  }
}

std::vector<std::string> ZipReader::names() const {
  std::vector<std::string> names;
  for (const Entry& entry : entries_) names.push_back(entry.name);
  return names;
}

std::optional<std::string> ZipReader::read(std::string_view name) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& e) { return lower(e.name) == lower(name); });
  if (found == entries_.end()) return {};
  const Entry& entry = *found;
  if (number(entry.offset, 4) != part_mark)
    fail(fmt::format("'{}' is not where it should be", shown(name)));
  const std::uint64_t start =
      entry.offset + 30 + number(entry.offset + 26, 2) + number(entry.offset + 28, 2);
  if (start > content_.size() || entry.packed > content_.size() - start) {
    fail(fmt::format("'{}' goes beyond the end", shown(name)));
  }
  if (entry.flags & 1 || (entry.method != 0 && entry.method != packed_method)) {
    throw Unsupported(
        file_,
        fmt::format("'{}' is encrypted or packed in a way that is not read here", shown(name)),
        "Pack it in the ordinary way (deflate)");
  }
  std::string part = unpack(entry, content_.substr(start, entry.packed));
  const auto checksum = crc32_z(crc32(0, nullptr, 0), zlib_bytes(part), part.size());
  if (checksum != entry.checksum) fail(fmt::format("the checksum of '{}' is wrong", shown(name)));
  return part;
}

std::string ZipReader::unpack(const Entry& entry, std::string_view packed) const {
  if (entry.method == 0) return std::string(packed);
  // Surfaces pack to a third, flat ones to a hundredth; a thousandth is meant to fill the memory.
  constexpr std::uint64_t always = std::uint64_t{1} << 26, most_ratio = 300;
  if (entry.size > always && entry.size / most_ratio > packed.size()) {
    throw FileError(file_,
                    fmt::format("'{}' would unpack to {} bytes", shown(entry.name), entry.size),
                    "Pack it again, if it is to be trusted");
  }
  std::string part(std::min(entry.size, always + most_ratio * packed.size()), '\0');
  z_stream stream{};
  if (inflateInit2(&stream, -15) != Z_OK) throw std::bad_alloc();
  std::size_t done = 0, used = 0;
  int status = Z_OK;
  constexpr std::size_t step = std::size_t{1} << 30;
  while (status == Z_OK) {
    const std::size_t in = std::min(step, packed.size() - used),
                      out = std::min(step, part.size() - done);
    stream.next_in = zlib_bytes(packed.substr(used));
    stream.avail_in = static_cast<uInt>(in);
    stream.next_out = reinterpret_cast<Bytef*>(part.data() + done);
    stream.avail_out = static_cast<uInt>(out);
    status = inflate(&stream, Z_NO_FLUSH);
    used += in - stream.avail_in;
    done += out - stream.avail_out;
  }
  inflateEnd(&stream);
  if (status != Z_STREAM_END || done != entry.size)
    fail(fmt::format("'{}' cannot be unpacked", shown(entry.name)));
  return part;
}

}  // namespace surf::io
