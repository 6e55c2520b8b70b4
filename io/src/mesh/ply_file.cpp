// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include "files/text_scanner.h"
#include "little_endian.h"
#include "mesh_format.h"
#include "ply_header.h"
#include "surf/core/error.h"
#include "text_output.h"

namespace surf::io {
namespace {

/// Values of a text body, one element per line.
class TextBody {
 public:
  TextBody(const std::string& file, std::string_view content, std::size_t start)
      : scanner_(file, content) {
    scanner_.go_to(start);
  }

  void begin_element(const PlyElement& element, std::uint64_t index) {
    if (element.properties.empty()) return;
    if (!scanner_.next_filled_line()) {
      fail(fmt::format("the file ends after {} of {} of '{}'", index, element.count,
                       shown(element.name)));
    }
  }
  void end_element() { scanner_.expect_line_end("the last property"); }

  double value(PlyType type) {
    return is_whole(type) ? static_cast<double>(whole(type)) : scanner_.number("a number");
  }
  std::int64_t whole(PlyType) { return scanner_.integer("a whole number"); }
  void skip(PlyType) {
    if (scanner_.word().empty()) fail("the line ends too early");
  }
  bool at_end() { return scanner_.at_end(); }

  [[noreturn]] void fail(const std::string& reason) const { scanner_.fail(reason); }

 private:
  TextScanner scanner_;
};

template <class T, class Bits>
T number_from(const char* bytes, bool swap) {
  static_assert(sizeof(T) == sizeof(Bits));
  Bits bits;
  std::memcpy(&bits, bytes, sizeof bits);
  if (swap) {
    Bits turned = 0;
    for (std::size_t i = 0; i < sizeof bits; ++i) {
      turned = static_cast<Bits>((turned << 8) | ((bits >> (8 * i)) & 0xff));
    }
    bits = turned;
  }
  return std::bit_cast<T>(bits);
}

/// Values of a binary body.
class BinaryBody {
 public:
  BinaryBody(const std::string& file, std::string_view content, std::size_t start, bool big_endian)
      : file_(file), content_(content), position_(start),
        swap_(big_endian != (std::endian::native == std::endian::big)) {}

  void begin_element(const PlyElement& element, std::uint64_t index) {
    element_ = &element;
    index_ = index;
  }
  void end_element() {}

  double value(PlyType type) {
    if (type == PlyType::float32) return number_from<float, std::uint32_t>(take(4), swap_);
    if (type == PlyType::float64) return number_from<double, std::uint64_t>(take(8), swap_);
    return static_cast<double>(whole(type));
  }
  std::int64_t whole(PlyType type) {
    const char* const bytes = take(bytes_of(type));
    switch (type) {
      case PlyType::int8:
        return number_from<std::int8_t, std::uint8_t>(bytes, swap_);
      case PlyType::uint8:
        return number_from<std::uint8_t, std::uint8_t>(bytes, swap_);
      case PlyType::int16:
        return number_from<std::int16_t, std::uint16_t>(bytes, swap_);
      case PlyType::uint16:
        return number_from<std::uint16_t, std::uint16_t>(bytes, swap_);
      case PlyType::int32:
        return number_from<std::int32_t, std::uint32_t>(bytes, swap_);
      case PlyType::uint32:
        return number_from<std::uint32_t, std::uint32_t>(bytes, swap_);
      default:
        fail("a whole number is expected");
    }
  }
  void skip(PlyType type) { take(bytes_of(type)); }

  /// Some programs end a binary file with a line end.
  bool at_end() const {
    return content_.find_first_not_of("\r\n", position_) == std::string_view::npos;
  }

  [[noreturn]] void fail(const std::string& reason) const {
    const std::string place =
        element_ ? fmt::format(", {} {}", shown(element_->name), index_) : std::string{};
    throw FileError(fmt::format("{}{}, byte {}", file_, place, position_), reason,
                    "Copy or export the file again");
  }

 private:
  const char* take(std::size_t bytes) {
    if (content_.size() - position_ < bytes) fail("the file is cut off");
    const char* const start = content_.data() + position_;
    position_ += bytes;
    return start;
  }

  std::string file_;
  std::string_view content_;
  std::size_t position_;
  bool swap_;
  const PlyElement* element_ = nullptr;
  std::uint64_t index_ = 0;
};

template <class Body>
std::uint64_t list_length(Body& body, const PlyProperty& property) {
  const std::int64_t length = body.whole(*property.count_type);
  if (length < 0) body.fail(fmt::format("the length of a list is {}", length));
  return static_cast<std::uint64_t>(length);
}

template <class Body>
void skip_property(Body& body, const PlyProperty& property) {
  const std::uint64_t values = property.count_type ? list_length(body, property) : 1;
  for (std::uint64_t i = 0; i < values; ++i) body.skip(property.type);
}

/// Properties of vertices that are no scalars of a surface.
bool has_other_meaning(std::string_view name) {
  static constexpr std::array<std::string_view, 14> others{
      "x", "y", "z", "nx", "ny", "nz", "s", "t", "u", "v", "red", "green", "blue", "alpha"};
  return std::find(others.begin(), others.end(), name) != others.end();
}

/// Which scalar each property is; -1: none.
std::vector<int> scalar_properties(const PlyElement& element, const SurfaceNote& note,
                                   Surface& surface) {
  std::vector<int> scalar_of;
  for (const PlyProperty& property : element.properties) {
    if (property.count_type || has_other_meaning(property.name)) {
      scalar_of.push_back(-1);
      continue;
    }
    scalar_of.push_back(static_cast<int>(surface.scalars.size()));
    const auto unit = note.scalar_units.find(property.name);
    surface.scalars.push_back(
        {property.name, unit == note.scalar_units.end() ? "1" : unit->second, {}});
    surface.scalars.back().values.reserve(element.count);
  }
  return scalar_of;
}

template <class Body>
void read_vertices(Body& body, const PlyElement& element, const SurfaceNote& note, Want want,
                   Surface& surface) {
  TriangleMesh& mesh = surface.mesh;
  const std::array<int, 3> axes{element.find("x"), element.find("y"), element.find("z")};
  for (const int axis : axes) {
    if (axis < 0 || element.properties[static_cast<std::size_t>(axis)].count_type) {
      body.fail("the vertices lack a property x, y or z");
    }
  }
  std::vector<int> scalar_of(element.properties.size(), -1);
  if (want == Want::everything) scalar_of = scalar_properties(element, note, surface);
  mesh.vertices_nm.reserve(element.count);
  for (std::uint64_t i = 0; i < element.count; ++i) {
    body.begin_element(element, i);
    std::array<double, 3> xyz{};
    for (int p = 0; p < static_cast<int>(element.properties.size()); ++p) {
      const PlyProperty& property = element.properties[static_cast<std::size_t>(p)];
      const auto axis = std::find(axes.begin(), axes.end(), p) - axes.begin();
      if (const int scalar = scalar_of[static_cast<std::size_t>(p)]; scalar >= 0) {
        auto& values = surface.scalars[static_cast<std::size_t>(scalar)].values;
        values.push_back(static_cast<float>(body.value(property.type)));
        continue;
      }
      if (axis == 3) {
        skip_property(body, property);
        continue;
      }
      const double value = body.value(property.type);
      if (!std::isfinite(value)) body.fail("a coordinate is not a finite number");
      xyz[static_cast<std::size_t>(axis)] = value;
    }
    body.end_element();
    mesh.vertices_nm.push_back({xyz[0], xyz[1], xyz[2]});
  }
}

/// The corners of one face, checked against the number of vertices.
template <class Body>
void read_corners(Body& body, const PlyProperty& property, std::uint64_t vertices,
                  std::vector<std::uint32_t>& corners) {
  const std::uint64_t length = list_length(body, property);
  if (length < 3) body.fail(fmt::format("a face has {} corners; it needs three or more", length));
  corners.clear();
  for (std::uint64_t i = 0; i < length; ++i) {
    const std::int64_t index = body.whole(property.type);
    if (index < 0 || static_cast<std::uint64_t>(index) >= vertices) {
      body.fail(fmt::format("a face names vertex {}, but they run from 0 to {}", index,
                            static_cast<std::int64_t>(vertices) - 1));
    }
    corners.push_back(static_cast<std::uint32_t>(index));
  }
}

template <class Body>
void read_faces(Body& body, const PlyElement& element, std::uint64_t vertices, TriangleMesh& mesh) {
  const int list = std::max(element.find("vertex_indices"), element.find("vertex_index"));
  if (list < 0 || !element.properties[static_cast<std::size_t>(list)].count_type ||
      !is_whole(element.properties[static_cast<std::size_t>(list)].type)) {
    body.fail("the faces lack a list of whole numbers vertex_indices or vertex_index");
  }
  mesh.triangles.reserve(element.count);
  std::vector<std::uint32_t> corners;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    body.begin_element(element, i);
    for (int p = 0; p < static_cast<int>(element.properties.size()); ++p) {
      const PlyProperty& property = element.properties[static_cast<std::size_t>(p)];
      if (p == list) {
        read_corners(body, property, vertices, corners);
      } else {
        skip_property(body, property);
      }
    }
    body.end_element();
    add_fan(corners, mesh.triangles);
  }
}

template <class Body>
void skip_element(Body& body, const PlyElement& element) {
  if (element.properties.empty()) return;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    body.begin_element(element, i);
    for (const PlyProperty& property : element.properties) skip_property(body, property);
    body.end_element();
  }
}

template <class Body>
Surface read_body(Body body, const PlyHeader& header, std::uint64_t vertices, Want want) {
  Surface surface;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") {
      read_vertices(body, element, header.note, want, surface);
    } else if (element.name == "face") {
      read_faces(body, element, vertices, surface.mesh);
    } else {
      skip_element(body, element);
    }
  }
  if (!body.at_end()) body.fail("there is more in the file than its header announces");
  return surface;
}

const PlyElement& only_element(const std::string& file, const PlyHeader& header,
                               std::string_view name) {
  const PlyElement* found = nullptr;
  for (const PlyElement& element : header.elements) {
    if (element.name != name) continue;
    if (found) {
      throw FileError(file, fmt::format("the element '{}' comes twice", name), "Export it again");
    }
    found = &element;
  }
  if (!found) {
    throw FileError(file, fmt::format("it has no element '{}'", name),
                    "Export a surface of polygons, not points or triangle strips");
  }
  return *found;
}

/// Names that PLY's readers take for something else.
bool is_taken_in_ply(const std::string& name) {
  static const std::set<std::string> taken{"x", "y", "z", "nx",  "ny",    "nz",   "s",
                                           "t", "u", "v", "red", "green", "blue", "alpha"};
  return taken.contains(name);
}

std::string format_ply(const std::string& file, const SceneView& scene) {
  const std::size_t vertices = count_vertices(scene);
  // Signed indices, as most readers expect them.
  if (vertices > std::numeric_limits<std::int32_t>::max()) refuse_size(file, "vertices", vertices);
  const auto scalars = common_scalars(scene);
  SurfaceNote note = scene.note;
  std::string properties;
  for (const auto& scalar : scalars) {
    const std::string& name = scalar.front()->name;
    if (is_taken_in_ply(name)) {
      throw InvalidInput(
          file,
          fmt::format("a scalar cannot be called '{}' in PLY, where this has a meaning", name),
          "Give it a longer name");
    }
    properties += fmt::format("property float {}\n", name);
    note.scalar_units[name] = scalar.front()->unit;
  }
  std::string content = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment written by semsurf\n{}element vertex {}\n"
      "property double x\nproperty double y\nproperty double z\n{}element face {}\n"
      "property list uchar int vertex_indices\nend_header\n",
      comments(note, false, "comment "), vertices, properties, count_triangles(scene));
  content.reserve(content.size() + (24 + 4 * scalars.size()) * vertices +
                  13 * count_triangles(scene));
  LittleEndian bytes(content);
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const auto& places = scene.surfaces[s].mesh->vertices_nm;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Vec3 v = note.to_file(places[i]);
      for (const double coordinate : {v.x, v.y, v.z}) bytes.add(coordinate);
      for (const auto& scalar : scalars) bytes.add(scalar[s]->values[i]);
    }
  }
  std::uint32_t first = 0;
  for (const SurfaceView& surface : scene.surfaces) {
    for (const Triangle& t : surface.mesh->triangles) {
      bytes.add(std::uint8_t{3});
      for (const std::uint32_t corner : t) bytes.add(first + corner);
    }
    first += static_cast<std::uint32_t>(surface.mesh->vertices_nm.size());
  }
  return content;
}

}  // namespace

bool is_ply(std::string_view content) {
  return content.starts_with("ply\n") || content.starts_with("ply\r");
}

ParsedFile parse_ply(const std::string& file, std::string_view content, Want want) {
  const PlyHeader header = parse_ply_header(file, content);
  const std::uint64_t vertices = only_element(file, header, "vertex").count;
  only_element(file, header, "face");
  if (vertices > max_mesh_vertices) {
    throw FileError(file, "it has too many vertices", "Simplify the mesh");
  }
  ParsedFile parsed;
  parsed.note = header.note;
  if (header.encoding == PlyEncoding::text) {
    parsed.bodies.push_back(
        {{}, read_body(TextBody(file, content, header.body), header, vertices, want)});
    return parsed;
  }
  const bool big_endian = header.encoding == PlyEncoding::big_endian;
  parsed.bodies.push_back(
      {{}, read_body(BinaryBody(file, content, header.body, big_endian), header, vertices, want)});
  return parsed;
}

constexpr std::array ply_forms{SurfaceFormat{.extension = ".ply", .scalars = true}};

constinit const MeshFormat ply_format{
    .forms = ply_forms,
    .is = is_ply,
    .parse = [](const MeshSource& s) { return parse_ply(s.file(), s.content, s.want); },
    .format =
        [](const std::filesystem::path& path, const SceneView& scene) {
          return one_file(path, format_ply(path.string(), scene));
        }};

}  // namespace surf::io
