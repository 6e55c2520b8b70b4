// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>

#include "files/cache_entry.h"
#include "files/sha256.h"
#include "files/zip_file.h"
#include "memory_files.h"
#include "mutators.h"
#include "surf/core/error.h"

namespace surf::test {
namespace {

std::uint32_t little(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4 && at + i < bytes.size(); ++i)
    value |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << 8 * i;
  return value;
}

std::string little_bytes(std::uint64_t value, std::size_t size) {
  std::string bytes;
  for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(value >> 8 * i);
  return bytes;
}

/// A text of the same length, filled up with `fill`.
std::string of_length(std::string text, std::size_t length, char fill) {
  text.resize(length, fill);
  return text;
}

/// Changes the text in front of `split`, or the numbers behind it. `mend` mends a changed head.
template <class Mend>
std::string mutate_parts(std::string_view content, std::size_t split, Chance& chance, Mend mend) {
  split = std::min(split, content.size());
  const std::string_view head = content.substr(0, split), body = content.substr(split);
  if (body.empty() || chance.one_in(2))
    return mend(mutate_counted_text(head, chance)) + std::string(body);
  return std::string(head) + mutate_numbers(body, chance);
}

std::string unchanged(std::string head) { return head; }

/// Behind the mark, or everything where it is missing.
std::size_t behind(std::string_view content, std::string_view mark) {
  const std::size_t at = content.find(mark);
  return at == std::string_view::npos ? content.size() : at + mark.size();
}

constexpr std::size_t stl_head = 84, stl_triangle = 50;

bool is_binary_stl(std::string_view content) {
  return content.size() >= stl_head + stl_triangle && content.find('\0') != std::string_view::npos;
}

}  // namespace

std::string mutate_stl(std::string_view content, Chance& chance) {
  if (!is_binary_stl(content)) return mutate_counted_text(content, chance);
  std::string bytes = mutate_numbers(content, chance);
  std::size_t triangles = (bytes.size() - stl_head) / stl_triangle;
  if (chance.one_in(8)) {  // one more, copied
    bytes.resize(stl_head + triangles * stl_triangle);
    bytes += bytes.substr(stl_head + chance.below(triangles) * stl_triangle, stl_triangle);
    ++triangles;
  }
  if (!chance.one_in(16)) bytes.replace(80, 4, little_bytes(triangles, 4));
  return bytes;
}

std::string mutate_ply(std::string_view content, Chance& chance) {
  constexpr std::string_view end = "end_header\n";
  const std::size_t split = behind(content, end);
  if (content.find("ascii") > split) return mutate_parts(content, split, chance, unchanged);
  const std::string_view head = content.substr(0, split), body = content.substr(split);
  if (chance.one_in(4)) return mutate_counted_text(head, chance) + std::string(body);
  return std::string(head) + mutate_counted_text(body, chance);
}

std::string mutate_glb(std::string_view content, Chance& chance) {
  constexpr std::size_t header = 12, chunk_header = 8;
  if (content.size() < header + chunk_header) return chance.change_bytes(std::string(content));
  const std::string_view all_chunks = content.substr(header);
  const std::size_t json_size =
      std::min<std::size_t>(little(all_chunks, 0), all_chunks.size() - chunk_header);
  std::string json(all_chunks.substr(chunk_header, json_size));
  std::string rest(all_chunks.substr(chunk_header + json_size));
  if (rest.size() > chunk_header && chance.one_in(3)) {
    rest = rest.substr(0, chunk_header) + mutate_numbers(rest.substr(chunk_header), chance);
  } else {
    json = mutate_json(json, chance);
    while (json.size() % 4 != 0) json += ' ';
  }
  const std::string chunks =
      little_bytes(json.size(), 4) + std::string(all_chunks.substr(4, 4)) + json + rest;
  std::string result(content.substr(0, 8));
  result += little_bytes(header + chunks.size(), 4);
  return result + chunks;
}

std::string mutate_zip(std::string_view content, Chance& chance) {
  if (chance.one_in(8)) return mutate_numbers(content, chance);
  try {
    const io::ZipReader archive("archive", content);
    const std::vector<std::string> names = archive.names();
    const std::size_t changed = chance.below(names.size());
    io::ZipWriter writer("archive");
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string part = archive.read(names[i]).value_or("");
      writer.begin(names[i]);
      writer.append(i == changed ? mutate_counted_text(part, chance) : part);
    }
    return writer.finish();
  } catch (const Error&) {
    return mutate_numbers(content, chance);  // it was no archive before
  }
}

std::string mutate_gsf(std::string_view content, Chance& chance) {
  const std::size_t text_end = std::min(content.find('\0'), content.size());
  const std::size_t split = text_end + (4 - text_end % 4);
  return mutate_parts(content, split, chance, [](std::string head) {
    head.erase(std::remove(head.begin(), head.end(), '\0'), head.end());
    return of_length(head, head.size() + (4 - head.size() % 4), '\0');
  });
}

std::string mutate_ibw(std::string_view content, Chance& chance) {
  constexpr std::size_t checked = 384, sum_at = 2;
  std::string bytes = mutate_numbers(content, chance);
  if (bytes.size() < checked || chance.one_in(16)) return bytes;
  // Its first 384 bytes add up to 0, as numbers of 16 bits.
  const bool big = bytes[0] == 0;
  const auto word = [&](std::size_t at) {
    const auto low = static_cast<unsigned char>(bytes[at + (big ? 1 : 0)]);
    const auto high = static_cast<unsigned char>(bytes[at + (big ? 0 : 1)]);
    return static_cast<unsigned>(low) | static_cast<unsigned>(high) << 8;
  };
  unsigned sum = 0;
  for (std::size_t at = 0; at < checked; at += 2)
    if (at != sum_at) sum += word(at);
  const unsigned rest = 0x10000 - (sum & 0xffff);
  bytes[sum_at + (big ? 1 : 0)] = static_cast<char>(rest);
  bytes[sum_at + (big ? 0 : 1)] = static_cast<char>(rest >> 8);
  return bytes;
}

std::string mutate_nanoscope(std::string_view content, Chance& chance) {
  const std::size_t split = behind(content, "\x1A");
  return mutate_parts(content, split, chance,
                      [&](std::string head) { return of_length(std::move(head), split, '\x1A'); });
}

std::string mutate_wsxm(std::string_view content, Chance& chance) {
  const std::size_t split = behind(content, "[Header end]");
  return mutate_parts(content, split, chance, [&](std::string head) {
    return head.size() == split ? head : of_length(std::move(head), split, ' ');
  });
}

std::string mutate_nid(std::string_view content, Chance& chance) {
  return mutate_parts(content, behind(content, "#!") - 2, chance, unchanged);
}

std::string mutate_sxm(std::string_view content, Chance& chance) {
  return mutate_parts(content, behind(content, "\x1A\x04") - 2, chance, unchanged);
}

std::string mutate_cache_entry(std::string_view content, Chance& chance) {
  // As io/src/files/cache_entry.h says: the head with both lengths and the checksum, key, payload.
  constexpr std::size_t head = 48, key_size_at = 20;
  if (content.size() < head || chance.one_in(8)) return mutate_numbers(content, chance);
  const std::string_view rest = content.substr(head);
  const std::size_t split = std::min<std::size_t>(little(content, key_size_at), rest.size());
  std::string key(rest.substr(0, split)), payload(rest.substr(split));
  if (chance.one_in(2)) payload = mutate_numbers(payload, chance);
  else key = mutate_text(key, chance);
  const std::filesystem::path path = descriptor_file("");
  io::write_entry(path, key, std::as_bytes(std::span(payload)));
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator(in), {}};
}

std::string mutate_checkpoint(std::string_view content, Chance& chance) {
  // As workflow/src/checkpoint_file.h says: letters, length, SHA-256, content.
  constexpr std::string_view tag = "semsurfB";
  constexpr std::size_t digits = 64, head = tag.size() + 8 + digits;
  std::string result;
  for (std::size_t at = 0; at + head <= content.size();) {
    const std::string_view block = content.substr(at);
    const std::size_t size = std::min<std::size_t>(little(block, tag.size()), block.size() - head);
    std::string inside(block.substr(head, size));
    if (chance.one_in(2)) inside = mutate_numbers(inside, chance);
    io::Sha256 hash;
    hash.add(inside.data(), inside.size());
    result.append(tag).append(little_bytes(inside.size(), 8)).append(hash.hexadecimal());
    result += inside;
    at += head + size;
  }
  return result.empty() || chance.one_in(8) ? mutate_numbers(content, chance) : result;
}

}  // namespace surf::test
