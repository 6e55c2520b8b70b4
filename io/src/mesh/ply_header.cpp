// SPDX-License-Identifier: GPL-3.0-or-later
#include "ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "files/damaged.h"
#include "files/text_scanner.h"
#include "surf/core/error.h"

namespace surf::io {
namespace {

PlyType parse_type(TextScanner& scanner) {
  static constexpr std::array<std::pair<std::string_view, PlyType>, 16> types{{
      {"char", PlyType::int8},
      {"int8", PlyType::int8},
      {"uchar", PlyType::uint8},
      {"uint8", PlyType::uint8},
      {"short", PlyType::int16},
      {"int16", PlyType::int16},
      {"ushort", PlyType::uint16},
      {"uint16", PlyType::uint16},
      {"int", PlyType::int32},
      {"int32", PlyType::int32},
      {"uint", PlyType::uint32},
      {"uint32", PlyType::uint32},
      {"float", PlyType::float32},
      {"float32", PlyType::float32},
      {"double", PlyType::float64},
      {"float64", PlyType::float64},
  }};
  const std::string_view word = scanner.word();
  for (const auto& [name, type] : types) {
    if (name == word) return type;
  }
  scanner.fail(fmt::format("'{}' is not a PLY number type", shown(word)));
}

PlyEncoding parse_format(TextScanner& scanner) {
  const std::string_view format = scanner.word();
  const std::string_view version = scanner.word();
  if (version != "1.0") {
    scanner.fail(fmt::format("PLY version '{}' is not known", shown(version)), "Export PLY 1.0");
  }
  if (format == "ascii") return PlyEncoding::text;
  if (format == "binary_little_endian") return PlyEncoding::little_endian;
  if (format == "binary_big_endian") return PlyEncoding::big_endian;
  scanner.fail(fmt::format("'{}' is not a PLY format", shown(format)));
}

PlyElement parse_element(TextScanner& scanner) {
  PlyElement element;
  element.name = scanner.word();
  const std::int64_t count = scanner.integer("the number of elements");
  if (count < 0) scanner.fail("a count is negative");
  element.count = static_cast<std::uint64_t>(count);
  return element;
}

void parse_property(TextScanner& scanner, std::vector<PlyElement>& elements) {
  if (elements.empty()) scanner.fail("a property comes before any element");
  PlyProperty property;
  const std::size_t place = scanner.position();
  if (scanner.word() == "list") {
    property.count_type = parse_type(scanner);
    if (!is_whole(*property.count_type)) {
      scanner.fail("the length of a list must have a whole number type");
    }
  } else {
    scanner.go_to(place);
  }
  property.type = parse_type(scanner);
  property.name = scanner.word();
  if (property.name.empty()) scanner.fail("a property has no name");
  if (elements.back().find(property.name) >= 0) {
    scanner.fail(fmt::format("the property '{}' comes twice", shown(property.name)));
  }
  elements.back().properties.push_back(std::move(property));
}

/// The fewest bytes that one element takes.
std::uint64_t smallest_size(const PlyElement& element, PlyEncoding encoding) {
  std::uint64_t bytes = 0;
  for (const PlyProperty& property : element.properties) {
    bytes +=
        encoding == PlyEncoding::text ? 2 : bytes_of(property.count_type.value_or(property.type));
  }
  return bytes;
}

void check_counts(const TextScanner& scanner, const PlyHeader& header, std::size_t bytes) {
  // The last line of a text may lack its end.
  const std::uint64_t available = bytes - header.body + 1;
  for (const PlyElement& element : header.elements) {
    const std::uint64_t size = smallest_size(element, header.encoding);
    if (size > 0 && element.count > available / size) {
      scanner.fail(fmt::format("the header announces {} of '{}', but only {} bytes follow",
                               element.count, shown(element.name), bytes - header.body),
                   copy_again);
    }
  }
}

}  // namespace

std::size_t bytes_of(PlyType type) {
  static constexpr std::array<std::size_t, 8> bytes{1, 1, 2, 2, 4, 4, 4, 8};
  return bytes[static_cast<std::size_t>(type)];
}

int PlyElement::find(std::string_view property) const {
  const auto found = std::find_if(properties.begin(), properties.end(),
                                  [&](const PlyProperty& p) { return p.name == property; });
  return found == properties.end() ? -1 : static_cast<int>(found - properties.begin());
}

PlyHeader parse_ply_header(const std::string& file, std::string_view content) {
  PlyHeader header;
  TextScanner scanner(file, content);
  if (scanner.word_on_any_line() != "ply") {
    scanner.fail("the first line is not 'ply'", "Check that this is a PLY file");
  }
  bool has_format = false;
  for (;;) {
    const std::string_view keyword = scanner.word_on_any_line();
    if (keyword == "comment" || keyword == "obj_info") {
      const std::size_t start = std::min(scanner.position() + 1, content.size());
      scanner.skip_line();
      const std::size_t end = std::min(scanner.position(), content.size());
      if (start < end) {
        const std::string_view line = content.substr(start, end - start);
        apply_line(line.substr(0, line.find_first_of("\r\n")), file, header.note);
      }
    } else if (keyword == "format") {
      header.encoding = parse_format(scanner);
      has_format = true;
    } else if (keyword == "element") {
      header.elements.push_back(parse_element(scanner));
    } else if (keyword == "property") {
      parse_property(scanner, header.elements);
    } else if (keyword == "end_header") {
      break;
    } else if (keyword.empty()) {
      scanner.fail("the file ends inside the header", copy_again);
    } else {
      scanner.fail(fmt::format("'{}' does not belong in a PLY header", shown(keyword)));
    }
    scanner.expect_line_end("the header's line");
  }
  if (!has_format) scanner.fail("the header does not tell the format");
  // Binary data may begin with bytes that look like blanks: step over one line end and no more.
  header.body = scanner.position();
  if (content.substr(header.body).starts_with("\r\n")) header.body += 2;
  else if (content.substr(header.body).starts_with("\n")) header.body += 1;
  else if (header.body < content.size()) scanner.fail("'end_header' does not end its line");
  check_counts(scanner, header, content.size());
  return header;
}

}  // namespace surf::io
