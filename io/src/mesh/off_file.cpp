// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <utility>

#include "files/damaged.h"
#include "files/text_scanner.h"
#include "mesh_format.h"
#include "text_output.h"

namespace surf::io {
namespace {

constexpr TextScanner::Syntax off_syntax{.comment = '#'};

/// What the first word says: [ST][C][N]OFF with texture coordinates, colours, normals.
struct Header {
  bool present = false;
  bool has_extras = false;
  bool is_supported = true;
};

Header header_of(std::string_view word) {
  Header header;
  if (!word.ends_with("OFF")) return header;
  const std::string_view prefix = word.substr(0, word.size() - 3);
  header.present = prefix.find_first_not_of("STCN4n") == prefix.npos;
  header.has_extras = !prefix.empty();
  header.is_supported = prefix.find_first_of("4n") == prefix.npos;
  return header;
}

struct Counts {
  std::uint64_t vertices;
  std::uint64_t faces;
};

/// The counts' line; the number of edges is optional and, by custom, often wrong.
Counts parse_counts(TextScanner& scanner, std::size_t bytes) {
  const std::int64_t vertices = scanner.integer("the number of vertices");
  const std::int64_t faces = scanner.integer("the number of faces");
  if (!scanner.at_line_end()) scanner.integer("the number of edges");
  scanner.expect_line_end("the counts");
  if (vertices < 0 || faces < 0) scanner.fail("a count is negative");
  // The shortest vertex is "0 0 0\n", the shortest face "3 0 1 2\n".
  const auto v = static_cast<std::uint64_t>(vertices);
  const auto f = static_cast<std::uint64_t>(faces);
  if (v > bytes / 5 || f > bytes / 7 || v > max_mesh_vertices) {
    scanner.fail(fmt::format("{} vertices and {} faces do not fit in {} bytes", v, f, bytes),
                 "The file is cut off or its header is wrong: export it again");
  }
  return {v, f};
}

void expect_line(TextScanner& scanner, std::string_view what, std::uint64_t done,
                 std::uint64_t count) {
  if (!scanner.next_filled_line()) {
    scanner.fail(fmt::format("the file ends after {} of {} {}", done, count, what), copy_again);
  }
}

void parse_face(TextScanner& scanner, std::uint64_t vertices, std::vector<std::uint32_t>& corners) {
  const std::int64_t count = scanner.integer("the number of a face's corners");
  if (count < 3) {
    scanner.fail(fmt::format("a face has {} corners", count),
                 "Remove it: a face needs three or more");
  }
  corners.clear();
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t index = scanner.integer("a corner of a face");
    if (index < 0 || static_cast<std::uint64_t>(index) >= vertices) {
      scanner.fail(fmt::format("a face names vertex {}, but they run from 0 to {}", index,
                               static_cast<std::int64_t>(vertices) - 1));
    }
    corners.push_back(static_cast<std::uint32_t>(index));
  }
  scanner.skip_line();  // a colour
}

std::string format_off(const SceneView& scene) {
  std::string text = fmt::format("OFF\n{}{} {} 0\n", comments(scene.note, false, "# "),
                                 count_vertices(scene), count_triangles(scene));
  for (const SurfaceView& surface : scene.surfaces) {
    for (const Vec3& v : surface.mesh->vertices_nm)
      add_vertex_line(text, scene.note.to_file(v), "");
  }
  std::uint64_t first = 0;
  for (const SurfaceView& surface : scene.surfaces) {
    for (const Triangle& t : surface.mesh->triangles) {
      fmt::format_to(std::back_inserter(text), "3 {} {} {}\n", first + t[0], first + t[1],
                     first + t[2]);
    }
    first += surface.mesh->vertices_nm.size();
  }
  return text;
}

}  // namespace

bool is_off(std::string_view content) {
  return header_of(TextScanner("", content.substr(0, 4096), off_syntax).word_on_any_line()).present;
}

ParsedFile parse_off(const std::string& file, std::string_view content) {
  ParsedFile parsed;
  apply_comments(content, '#', file, parsed.note);
  TextScanner scanner(file, content, off_syntax);
  scanner.next_filled_line();
  const std::size_t start = scanner.position();
  const Header header = header_of(scanner.word());
  if (!header.present) scanner.go_to(start);  // the keyword is optional in files named *.off
  if (!header.is_supported) {
    scanner.fail("OFF with four or more coordinates per vertex", "Export plain OFF");
  }
  if (!scanner.next_filled_line()) scanner.fail("the file ends before the counts");
  if (content.substr(scanner.position()).starts_with("BINARY")) {
    scanner.fail("binary OFF cannot be read", "Export it as text, or as STL or PLY");
  }
  const Counts counts = parse_counts(scanner, content.size());

  TriangleMesh mesh;
  mesh.vertices_nm.reserve(counts.vertices);
  for (std::uint64_t i = 0; i < counts.vertices; ++i) {
    expect_line(scanner, "vertices", i, counts.vertices);
    const double x = scanner.number("the x of a vertex");
    const double y = scanner.number("the y of a vertex");
    const double z = scanner.number("the z of a vertex");
    if (header.has_extras) {
      scanner.skip_line();
    } else {
      scanner.expect_line_end("the three coordinates");
    }
    mesh.vertices_nm.push_back({x, y, z});
  }
  mesh.triangles.reserve(counts.faces);
  std::vector<std::uint32_t> corners;
  for (std::uint64_t i = 0; i < counts.faces; ++i) {
    expect_line(scanner, "faces", i, counts.faces);
    parse_face(scanner, counts.vertices, corners);
    add_fan(corners, mesh.triangles);
  }
  if (!scanner.at_end()) {
    scanner.fail(fmt::format("there is more after the {} faces", counts.faces),
                 "Check the counts in the header");
  }
  parsed.bodies.push_back({{}, {.mesh = std::move(mesh)}});
  return parsed;
}

constexpr std::array off_forms{SurfaceFormat{.extension = ".off"}};

constinit const MeshFormat off_format{
    .forms = off_forms,
    .is = is_off,
    .parse = [](const MeshSource& s) { return parse_off(s.file(), s.content); },
    .format = [](const std::filesystem::path& path,
                 const SceneView& scene) { return one_file(path, format_off(scene)); }};

}  // namespace surf::io
