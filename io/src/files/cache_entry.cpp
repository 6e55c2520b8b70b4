// SPDX-License-Identifier: GPL-3.0-or-later
// The only source that knows xxHash.
#include "cache_entry.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <system_error>

#include "surf/io/cache.h"

namespace surf::io {
namespace {

using Bytes = std::span<const std::byte>;
using Buffer = std::span<std::byte>;

// Line ends of three systems and an end-of-text mark: copying as text damages it.
constexpr char magic[] = "semsurf cache\r\n\x1a";
constexpr std::size_t magic_size = sizeof magic - 1;
constexpr std::size_t sums_size = 32;  ///< what lies before the checksum
constexpr std::size_t header_size = 48;
constexpr std::uint32_t version = 1;
/// Pieces that are still in the processor's cache when they are summed.
constexpr std::size_t piece_size = std::size_t{1} << 18;

using Header = std::array<std::byte, header_size>;
using Checksum = std::array<std::byte, 16>;
static_assert(magic_size == 16 && sizeof(XXH128_canonical_t) == sizeof(Checksum));

class Summer {
 public:
  Summer() : state_(XXH3_createState(), &XXH3_freeState) {
    if (!state_) throw std::bad_alloc();
    XXH3_128bits_reset(state_.get());
  }
  void add(Bytes bytes) { XXH3_128bits_update(state_.get(), bytes.data(), bytes.size()); }
  Checksum checksum() const {
    XXH128_canonical_t canonical;
    XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(state_.get()));
    Checksum sum;
    std::memcpy(sum.data(), canonical.digest, sum.size());
    return sum;
  }

 private:
  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
};

void put(Header& header, std::size_t at, std::size_t size, std::uint64_t value) {
  for (std::size_t i = 0; i < size; ++i) header[at + i] = static_cast<std::byte>(value >> (8 * i));
}

std::uint64_t get(const Header& header, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) {
    value |= std::to_integer<std::uint64_t>(header[at + i]) << (8 * i);
  }
  return value;
}

Bytes summed_part(const Header& header) { return Bytes(header).first(sums_size); }

/// Whether the buffer could be filled.
bool read_all(int file, Buffer buffer) {
  while (!buffer.empty()) {
    const ssize_t count = ::read(file, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    buffer = buffer.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

void write_all(int file, Bytes bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw std::system_error(errno, std::generic_category());
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

/// What is wrong with a header, or nothing.
std::string fault_of(const Header& header, std::uint64_t file_size) {
  if (std::memcmp(header.data(), magic, magic_size) != 0) return "is not a cache entry";
  const std::uint64_t written_version = get(header, 16, 4);
  if (written_version != version) {
    return fmt::format("has layout {}, not {}", written_version, version);
  }
  const std::uint64_t key_size = get(header, 20, 4);
  const std::uint64_t payload_size = get(header, 24, 8);
  if (key_size == 0 || key_size > Cache::max_key_bytes) return "was damaged (its key is)";
  // Compared by differences, which cannot overflow.
  const std::uint64_t rest = file_size - header_size;
  if (rest < key_size || rest - key_size < payload_size) return "was damaged (its end is missing)";
  if (rest - key_size > payload_size) return "was damaged (more follows its end)";
  return {};
}

/// Reads the payload piece by piece; keeps it if `kept` has room for it.
bool read_payload(int file, std::uint64_t size, Buffer kept, Summer& sum) {
  std::vector<std::byte> scratch(kept.empty() ? std::min<std::uint64_t>(size, piece_size) : 0);
  for (std::uint64_t done = 0; done < size;) {
    const std::size_t count = std::min<std::uint64_t>(size - done, piece_size);
    const Buffer piece = kept.empty() ? Buffer(scratch).first(count) : kept.subspan(done, count);
    if (!read_all(file, piece)) return false;
    sum.add(piece);
    done += count;
  }
  return true;
}

}  // namespace

FileDescriptor::~FileDescriptor() {
  if (file_ >= 0) ::close(file_);
}

FileDescriptor open_entry(const std::filesystem::path& path) {
  // Not to wait for the other end of a pipe.
  FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (!file || ::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) {
    return FileDescriptor();
  }
  return file;
}

EntryContent read_entry(const FileDescriptor& file, EntryPart part) {
  EntryContent content;
  struct stat status {};
  Header header;
  if (::fstat(file.get(), &status) != 0 || status.st_size < static_cast<off_t>(header_size) ||
      !read_all(file.get(), header)) {
    content.fault = "was damaged (it is too short)";
    return content;
  }
  content.fault = fault_of(header, static_cast<std::uint64_t>(status.st_size));
  if (!content.fault.empty()) return content;

  std::string key(get(header, 20, 4), '\0');
  const std::uint64_t payload_size = get(header, 24, 8);
  if (!read_all(file.get(), std::as_writable_bytes(std::span(key)))) {
    content.fault = "was damaged (it cannot be read)";
    return content;
  }
  if (part == EntryPart::header) {
    content.key = std::move(key);
    return content;
  }
  Summer sum;
  sum.add(summed_part(header));
  sum.add(std::as_bytes(std::span(key)));
  if (part == EntryPart::payload) content.payload.resize(payload_size);
  if (!read_payload(file.get(), payload_size, content.payload, sum)) {
    content.fault = "was damaged (it cannot be read)";
  } else if (const Checksum checksum = sum.checksum();
             std::memcmp(checksum.data(), header.data() + sums_size, checksum.size()) != 0) {
    content.fault = "was damaged (its checksum is wrong)";
  }
  if (content.fault.empty()) content.key = std::move(key);
  else content.payload.clear();
  return content;
}

void write_entry(const std::filesystem::path& path, const std::string& key, Bytes payload) {
  Header header;
  std::memcpy(header.data(), magic, magic_size);
  put(header, 16, 4, version);
  put(header, 20, 4, key.size());
  put(header, 24, 8, payload.size());
  const Bytes key_bytes = std::as_bytes(std::span(key));
  Summer sum;
  for (const Bytes part : {summed_part(header), key_bytes, payload}) sum.add(part);
  const Checksum checksum = sum.checksum();
  std::copy(checksum.begin(), checksum.end(), header.begin() + sums_size);

  const FileDescriptor file(::open(path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC));
  if (!file) throw std::system_error(errno, std::generic_category());
  for (const Bytes part : {Bytes(header), key_bytes, payload}) write_all(file.get(), part);
}

}  // namespace surf::io
