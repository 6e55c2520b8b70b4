// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstring>

#include "files/damaged.h"
#include "files/text_scanner.h"
#include "little_endian.h"
#include "mesh_format.h"
#include "surf/core/error.h"
#include "text_output.h"

namespace surf::io {
namespace {

constexpr std::size_t header_bytes = 84;
constexpr std::size_t facet_bytes = 50;

std::uint32_t little_endian_32(const char* bytes) {
  std::array<unsigned char, 4> b;
  std::memcpy(b.data(), bytes, 4);
  return b[0] | b[1] << 8 | b[2] << 16 | std::uint32_t{b[3]} << 24;
}

bool same_word(std::string_view a, std::string_view lower) {
  return std::equal(a.begin(), a.end(), lower.begin(), lower.end(),
                    [](unsigned char x, char y) { return std::tolower(x) == y; });
}

bool starts_with_solid(std::string_view content) {
  return same_word(TextScanner("", content.substr(0, 1000)).word_on_any_line(), "solid");
}

TriangleMesh parse_binary(const std::string& file, std::string_view content) {
  const std::uint32_t count = little_endian_32(content.data() + 80);
  TriangleMesh mesh;
  if (std::uint64_t{3} * count > max_mesh_vertices) {
    throw FileError(file, "it has too many triangles", "Simplify the mesh");
  }
  mesh.vertices_nm.reserve(std::size_t{3} * count);
  mesh.triangles.reserve(count);
  for (std::uint32_t facet = 0; facet < count; ++facet) {
    // The stored normal is ignored: the order of the corners says where outside is.
    const std::size_t offset = header_bytes + facet_bytes * facet + 12;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const char* const bytes = content.data() + offset + 12 * corner;
      const auto coordinate = [&](std::size_t i) {
        return double{std::bit_cast<float>(little_endian_32(bytes + 4 * i))};
      };
      const Vec3 vertex{coordinate(0), coordinate(1), coordinate(2)};
      if (!is_finite(vertex)) {
        throw FileError(fmt::format("{}, facet {}, byte {}", file, facet + 1, offset + 12 * corner),
                        "a corner is not a finite number", "Repair the mesh or export it again");
      }
      mesh.vertices_nm.push_back(vertex);
    }
    mesh.triangles.push_back({3 * facet, 3 * facet + 1, 3 * facet + 2});
  }
  return mesh;
}

void expect_word(TextScanner& scanner, std::string_view expected) {
  const std::string_view found = scanner.word_on_any_line();
  if (found.empty()) {
    scanner.fail(fmt::format("the file ends where '{}' is expected", expected), copy_again);
  }
  if (!same_word(found, expected)) {
    scanner.fail(fmt::format("expected '{}', found '{}'", expected, shown(found)));
  }
}

void parse_facet(TextScanner& scanner, TriangleMesh& mesh) {
  scanner.skip_line();  // the normal, which may be NaN for a degenerate facet
  expect_word(scanner, "outer");
  expect_word(scanner, "loop");
  for (int corner = 0; corner < 3; ++corner) {
    expect_word(scanner, "vertex");
    const double x = scanner.number("the x of a vertex");
    const double y = scanner.number("the y of a vertex");
    const double z = scanner.number("the z of a vertex");
    scanner.expect_line_end("the three coordinates");
    mesh.vertices_nm.push_back({x, y, z});
  }
  expect_word(scanner, "endloop");
  expect_word(scanner, "endfacet");
  const auto n = static_cast<std::uint32_t>(mesh.vertices_nm.size());
  mesh.triangles.push_back({n - 3, n - 2, n - 1});
}

TriangleMesh parse_text(const std::string& file, std::string_view content) {
  TriangleMesh mesh;
  TextScanner scanner(file, content);
  while (!scanner.at_end()) {
    expect_word(scanner, "solid");
    scanner.skip_line();
    for (;;) {
      const std::string_view word = scanner.word_on_any_line();
      if (same_word(word, "facet")) {
        parse_facet(scanner, mesh);
      } else if (same_word(word, "endsolid")) {
        scanner.skip_line();
        break;
      } else if (word.empty()) {
        scanner.fail("the file ends without 'endsolid'", copy_again);
      } else {
        scanner.fail(fmt::format("expected 'facet' or 'endsolid', found '{}'", shown(word)));
      }
    }
  }
  return mesh;
}

/// The unit normal; zero, as STL has it, for a triangle without area.
Vec3 normal_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = cross(b - a, c - a);
  const double size = length(normal);
  return size > 0 && std::isfinite(size) ? normal * (1 / size) : Vec3{};
}

void add_float32(LittleEndian& bytes, const Vec3& v, const std::string& file) {
  for (const double coordinate : {v.x, v.y, v.z}) {
    const auto value = static_cast<float>(coordinate);
    if (!std::isfinite(value)) {
      throw InvalidInput(file, fmt::format("the coordinate {} is too large for STL", coordinate),
                         "Write PLY, or use a larger unit");
    }
    bytes.add(value);
  }
}

std::string format_stl(const std::string& file, const SceneView& scene) {
  const std::size_t count = count_triangles(scene);
  if (count > std::numeric_limits<std::uint32_t>::max()) refuse_size(file, "triangles", count);
  std::string content = to_stl_header(scene.note);  // "solid" would announce text
  content.reserve(content.size() + 4 + 50 * count);
  LittleEndian bytes(content);
  bytes.add(static_cast<std::uint32_t>(count));
  for (const SurfaceView& surface : scene.surfaces) {
    const auto corner = [&](std::uint32_t v) {
      return scene.note.to_file(surface.mesh->vertices_nm[v]);
    };
    for (const Triangle& t : surface.mesh->triangles) {
      const Vec3 a = corner(t[0]), b = corner(t[1]), c = corner(t[2]);
      for (const Vec3& v : {normal_of(a, b, c), a, b, c}) add_float32(bytes, v, file);
      content.append(2, '\0');
    }
  }
  return content;
}

}  // namespace

bool is_binary_stl(std::string_view content) {
  return content.size() >= header_bytes &&
         content.size() == header_bytes + facet_bytes * little_endian_32(content.data() + 80);
}

bool is_text_stl(std::string_view content) {
  if (!starts_with_solid(content)) return false;
  const std::string_view start = content.substr(0, 4096);
  return start.find("facet") != std::string_view::npos ||
         start.find("FACET") != std::string_view::npos;
}

ParsedFile parse_stl(const std::string& file, std::string_view content) {
  ParsedFile parsed;
  if (is_binary_stl(content)) {
    apply_stl_header(content, file, parsed.note);
    parsed.bodies.push_back({{}, {.mesh = parse_binary(file, content)}});
    return parsed;
  }
  const bool has_zero_bytes = content.substr(0, 4096).find('\0') != std::string_view::npos;
  if (starts_with_solid(content) && !has_zero_bytes) {
    parsed.bodies.push_back({{}, {.mesh = parse_text(file, content)}});
    return parsed;
  }
  if (content.size() < header_bytes) {
    throw FileError(file, fmt::format("{} bytes are too few for an STL file", content.size()),
                    copy_again);
  }
  const std::uint64_t count = little_endian_32(content.data() + 80);
  throw FileError(file,
                  fmt::format("the header announces {} triangles, which take {} bytes, but the "
                              "file has {}",
                              count, header_bytes + facet_bytes * count, content.size()),
                  copy_again);
}

constexpr std::array stl_forms{SurfaceFormat{.extension = ".stl", .magnified = true}};

constinit const MeshFormat stl_format{
    .forms = stl_forms,
    .is = [](std::string_view content) { return is_binary_stl(content) || is_text_stl(content); },
    .parse = [](const MeshSource& s) { return parse_stl(s.file(), s.content); },
    .format =
        [](const std::filesystem::path& path, const SceneView& scene) {
          return one_file(path, format_stl(path.string(), scene));
        },
    .least = 1e-30};  // float32

}  // namespace surf::io
