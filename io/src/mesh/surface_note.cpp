// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_note.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "files/text_scanner.h"
#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf::io {
namespace {

constexpr std::string_view surface_prefix = "surface:";
constexpr std::string_view metadata_prefix = "semsurf:";
constexpr std::string_view stl_start = "semsurf mm magnification=";
constexpr std::string_view stl_z = " z=";  // no key of the metadata: those have dots
constexpr std::size_t stl_header_bytes = 80;
constexpr std::size_t most_names = 1'000'000;

[[noreturn]] void fail(const std::string& file, std::string_view key, std::string_view value) {
  throw FileError(file, fmt::format("its note {} is '{}'", key, shown(value)),
                  "Write the file again with semsurf");
}

double positive(std::string_view key, std::string_view text, const std::string& file) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end || !(value > 0) || !std::isfinite(value))
    fail(file, key, text);
  return value;
}

/// The number behind the dot of "name.3", from 1; 0 for another key.
std::size_t place_in(std::string_view key, std::string_view kind) {
  if (!key.starts_with(kind)) return 0;
  key.remove_prefix(kind.size());
  std::size_t place = 0;
  const auto [stop, error] = std::from_chars(key.data(), key.data() + key.size(), place);
  const bool is_place =
      error == std::errc{} && stop == key.data() + key.size() && place <= most_names;
  return is_place ? place : 0;
}

std::string encoded(std::string_view text, std::string_view also) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain =
        byte >= 0x20 && byte != 0x7f && c != '%' && c != '\\' && also.find(c) == also.npos;
    if (is_plain) result += c;
    else result += fmt::format("%{:02X}", byte);
  }
  return result;
}

std::string decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned byte = 0;
    const char* const code = text.data() + i + 1;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(code, code + 2, byte, 16).ptr == code + 2) {
      result += static_cast<char>(byte);
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> to_entries(const SurfaceNote& note,
                                                            bool magnified) {
  std::vector<std::pair<std::string, std::string>> entries;
  const auto add = [&](const std::string& key, const std::string& value) {
    entries.emplace_back(std::string(surface_prefix) + key, value);
  };
  if (magnified) add("magnification", format_exact(note.magnification));
  else add("unit_nm", format_exact(note.unit_nm));
  if (note.z_exaggeration != 1) add("z_exaggeration", format_exact(note.z_exaggeration));
  for (std::size_t i = 0; i < note.names.size(); ++i)
    add(fmt::format("name.{}", i + 1), note.names[i]);
  for (const auto& [place, picture] : note.drapes) add(fmt::format("drape.{}", place + 1), picture);
  for (const auto& [scalar, unit] : note.scalar_units) add("unit." + scalar, unit);
  for (const auto& [key, value] : note.metadata) {
    entries.emplace_back(std::string(metadata_prefix) + key, value);
  }
  return entries;
}

void apply_entry(std::string_view key, std::string_view value, const std::string& file,
                 SurfaceNote& note) {
  if (key.starts_with(metadata_prefix)) {
    note.metadata[std::string(key.substr(metadata_prefix.size()))] = value;
    return;
  }
  if (!key.starts_with(surface_prefix)) return;
  const std::string_view kind = key.substr(surface_prefix.size());
  note.is_ours = true;
  if (kind == "unit_nm") {
    note.unit_nm = positive(key, value, file);
    note.states_unit = true;
  } else if (kind == "magnification") {
    set_magnification(note, positive(key, value, file));
    note.states_unit = true;
    if (!(note.unit_nm > 0) || !std::isfinite(note.unit_nm)) fail(file, key, value);
  } else if (kind == "z_exaggeration") {
    note.z_exaggeration = positive(key, value, file);
  } else if (const std::size_t place = place_in(kind, "name."); place > 0) {
    if (note.names.size() < place) note.names.resize(place);
    note.names[place - 1] = value;
  } else if (const std::size_t draped = place_in(kind, "drape."); draped > 0) {
    note.drapes[draped - 1] = value;
  } else if (kind.starts_with("unit.")) {
    note.scalar_units[std::string(kind.substr(5))] = value;
  }
}

std::string to_line(std::string_view key, std::string_view value) {
  return encoded(key, "=") + '=' + encoded(value, {});
}

void apply_line(std::string_view line, const std::string& file, SurfaceNote& note) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  const std::size_t equals = line.find('=');
  if (equals == line.npos) return;
  apply_entry(decoded(line.substr(0, equals)), decoded(line.substr(equals + 1)), file, note);
}

void apply_comments(std::string_view content, char mark, const std::string& file,
                    SurfaceNote& note) {
  for (bool is_first = true; !content.empty(); is_first = false) {
    const std::size_t end = std::min(content.find('\n'), content.size());
    std::string_view line = content.substr(0, end);
    content.remove_prefix(std::min(end + 1, content.size()));
    if (!line.starts_with(mark)) {
      if (is_first) continue;
      return;
    }
    line.remove_prefix(std::min(line.find_first_not_of(' ', 1), line.size()));
    apply_line(line, file, note);
  }
}

std::string plain_name(std::string_view name) {
  std::string plain(name);
  std::replace_if(
      plain.begin(), plain.end(),
      [](unsigned char c) { return c <= 0x20 || c == 0x7f || c == '#' || c == '\\' || c == '/'; },
      '_');
  return plain;
}

std::string to_stl_header(const SurfaceNote& note) {
  std::string header = fmt::format("{}{}", stl_start, format_exact(note.magnification));
  if (note.z_exaggeration != 1)
    header += fmt::format("{}{}", stl_z, format_exact(note.z_exaggeration));
  for (const auto& [key, value] : note.metadata) {
    const std::string entry = fmt::format(" {}={}", encoded(key, "= "), encoded(value, " "));
    if (header.size() + entry.size() <= stl_header_bytes) header += entry;
  }
  header.resize(stl_header_bytes, ' ');
  return header;
}

void apply_stl_header(std::string_view header, const std::string& file, SurfaceNote& note) {
  header = header.substr(0, stl_header_bytes);
  if (!header.starts_with(stl_start)) return;
  header.remove_prefix(stl_start.size());
  const auto next = [&] {
    const std::size_t end = std::min(header.find(' '), header.size());
    const std::string_view word = header.substr(0, end);
    header.remove_prefix(std::min(end + 1, header.size()));
    return word;
  };
  apply_entry("surface:magnification", next(), file, note);
  while (!header.empty()) {
    const std::string_view word = next();
    const std::size_t equals = word.find('=');
    if (equals == word.npos) continue;
    const std::string_view value = word.substr(equals + 1);
    if (word.substr(0, equals) == "z") apply_entry("surface:z_exaggeration", value, file, note);
    else note.metadata[decoded(word.substr(0, equals))] = decoded(value);
  }
}

}  // namespace surf::io
