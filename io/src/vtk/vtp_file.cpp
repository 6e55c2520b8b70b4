// SPDX-License-Identifier: GPL-3.0-or-later
// Reads VTK's polygonal data as meshes, without VTK: its own reader crashes on damaged files.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <compare>
#include <map>

#include "files/text_scanner.h"
#include "mesh/mesh_format.h"
#include "mesh/split_mesh.h"
#include "surf/core/error.h"
#include "vtk_xml.h"
#include "vtp_format.h"

namespace surf::io {
namespace {

using Element = VtkXml::Element;

/// The cells of one kind in a piece: corners of all, and where each ends.
class Cells {
 public:
  Cells(const Element& piece, const char* kind, const char* count_name, std::size_t points) {
    const std::uint64_t count = piece.count(count_name);
    if (count == 0) return;
    const auto element = piece.child(kind);
    const auto corners = element ? element->array("connectivity") : std::nullopt;
    const auto offsets = element ? element->array("offsets") : std::nullopt;
    if (!corners || !offsets) piece.fail(fmt::format("the arrays of {} are missing", kind));
    if (offsets->values.size() < count) {
      element->fail(
          fmt::format("{} cells are announced, and there are {}", count, offsets->values.size()));
    }
    double last = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      const double end = offsets->values[i];
      if (!(end >= last && end <= static_cast<double>(corners->values.size()))) {
        element->fail(fmt::format("cell {} ends at corner {}", i, end));
      }
      ends_.push_back(static_cast<std::size_t>(end));
      last = end;
    }
    for (const double corner : corners->values) {
      if (!(corner >= 0 && corner < static_cast<double>(points))) {
        element->fail(fmt::format("a corner names point {} of {}", corner, points));
      }
      corners_.push_back(static_cast<std::uint32_t>(corner));
    }
  }

  std::size_t count() const { return ends_.size(); }

  void get(std::size_t cell, std::vector<std::uint32_t>& corners) const {
    const std::size_t begin = cell == 0 ? 0 : ends_[cell - 1];
    corners.assign(corners_.begin() + static_cast<std::ptrdiff_t>(begin),
                   corners_.begin() + static_cast<std::ptrdiff_t>(ends_[cell]));
  }

 private:
  std::vector<std::size_t> ends_;
  std::vector<std::uint32_t> corners_;
};

std::vector<Vec3> read_points(const Element& piece) {
  const std::uint64_t count = piece.count("NumberOfPoints");
  if (count == 0) return {};
  const auto element = piece.child("Points");
  const auto array = element ? element->array("") : std::nullopt;
  if (!array || array->components != 3 || array->values.size() / 3 != count ||
      count >= max_mesh_vertices) {
    piece.fail(fmt::format("it does not have the {} points that it announces", count));
  }
  std::vector<Vec3> points;
  points.reserve(count);
  for (std::size_t i = 0; i < array->values.size(); i += 3) {
    points.push_back({array->values[i], array->values[i + 1], array->values[i + 2]});
    if (!is_finite(points.back())) element->fail(fmt::format("point {} is not finite", i / 3));
  }
  return points;
}

/// Which material a cell is of, as far as the piece says so in texts.
class Materials {
 public:
  Materials(const Element& piece, std::size_t cells, std::size_t points)
      : cells_(texts(piece, "CellData", cells)), points_(texts(piece, "PointData", points)) {}

  std::string of(std::size_t cell, std::uint32_t first_corner) const {
    if (!cells_.empty()) return cells_[cell];
    return points_.empty() ? std::string{} : points_[first_corner];
  }

 private:
  static std::vector<std::string> texts(const Element& piece, const char* kind, std::size_t count) {
    const auto data = piece.child(kind);
    auto array = data ? data->array("material") : std::nullopt;
    if (!array || !array->is_text || array->texts.size() != count) return {};
    return std::move(array->texts);
  }

  std::vector<std::string> cells_;
  std::vector<std::string> points_;
};

/// Numbers in the cells that tell semsurf's surfaces apart.
std::vector<double> surface_numbers(const Element& piece, std::size_t cells, std::size_t surfaces) {
  const auto data = piece.child("CellData");
  auto array = data && surfaces > 1 ? data->array("surface") : std::nullopt;
  if (!array || array->is_text || array->components != 1 || array->values.size() != cells)
    return {};
  const auto is_known = [&](double number) {
    return number >= 0 && number < static_cast<double>(surfaces) && number == std::floor(number);
  };
  if (!std::all_of(array->values.begin(), array->values.end(), is_known)) {
    data->fail("its numbers of surfaces are not those of the names");
  }
  return std::move(array->values);
}

/// The arrays of the points that have one number for each.
std::vector<VertexScalar> read_scalars(const Element& piece, std::size_t points) {
  std::vector<VertexScalar> scalars;
  const auto data = piece.child("PointData");
  for (const Element& element : data ? data->children("DataArray") : std::vector<Element>{}) {
    const std::string name = element.attribute("Name");
    if (element.numbers("NumberOfComponents", {1})[0] != 1) continue;
    const auto array = data->array(name);
    if (!array || array->is_text || array->values.size() != points) continue;
    VertexScalar scalar{name, "1", {}};
    for (const Element& key : element.children("InformationKey")) {
      if (key.attribute("name") == "UNITS_LABEL") scalar.unit = key.text();
    }
    scalar.values.reserve(points);
    for (const double value : array->values) scalar.values.push_back(static_cast<float>(value));
    scalars.push_back(std::move(scalar));
  }
  return scalars;
}

/// Collects triangles, what tells them apart, and scalars.
class Triangles {
 public:
  Triangles(const std::vector<std::string>& names, Want want) : names_(names), want_(want) {}

  void add_piece(const Element& piece) {
    const std::vector<Vec3> points = read_points(piece);
    first_point_ = static_cast<std::uint32_t>(mesh_.vertices_nm.size());
    if (mesh_.vertices_nm.size() + points.size() >= max_mesh_vertices) {
      piece.fail("the file has too many points");
    }
    const Cells polygons(piece, "Polys", "NumberOfPolys", points.size());
    const Cells strips(piece, "Strips", "NumberOfStrips", points.size());
    const std::uint64_t first = piece.count("NumberOfVerts") + piece.count("NumberOfLines");
    const std::size_t cells = first + polygons.count() + strips.count();
    const Materials materials(piece, cells, points.size());
    surfaces_ = surface_numbers(piece, cells, names_.size());
    if (want_ == Want::everything && !points.empty())
      add_scalars(read_scalars(piece, points.size()));
    mesh_.vertices_nm.insert(mesh_.vertices_nm.end(), points.begin(), points.end());
    add(polygons, first, materials, add_fan);
    add(strips, first + polygons.count(), materials, add_strip);
  }

  std::vector<ParsedBody> bodies() {
    std::vector<ParsedBody> result;
    if (kinds_.size() == 1) {  // the vertices keep their order
      result.push_back(
          {kinds_[0].material, {name_of(kinds_[0]), std::move(mesh_), std::move(scalars_), {}}});
      return result;
    }
    std::vector<MeshPart> parts = split_in_order(mesh_, group_, kinds_.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      ParsedBody body{kinds_[i].material,
                      {.name = name_of(kinds_[i]), .mesh = std::move(parts[i].mesh)}};
      for (const VertexScalar& scalar : scalars_) {
        VertexScalar part{scalar.name, scalar.unit, {}};
        for (const std::uint32_t v : parts[i].vertices) part.values.push_back(scalar.values[v]);
        body.surface.scalars.push_back(std::move(part));
      }
      result.push_back(std::move(body));
    }
    return result;
  }

 private:
  struct Kind {
    std::size_t surface = 0;
    std::string material;
    auto operator<=>(const Kind&) const = default;
  };

  template <class Split>
  void add(const Cells& cells, std::size_t first_cell, const Materials& materials,
           const Split& split) {
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 0; i < cells.count(); ++i) {
      cells.get(i, corners);
      if (corners.size() < 3) continue;
      const std::size_t cell = first_cell + i;
      const std::size_t surface = surfaces_.empty() ? 0 : static_cast<std::size_t>(surfaces_[cell]);
      const auto [entry, is_new] = numbers_.try_emplace(
          Kind{surface, materials.of(cell, corners[0])}, static_cast<std::uint32_t>(kinds_.size()));
      if (is_new) kinds_.push_back(entry->first);
      for (std::uint32_t& corner : corners) corner += first_point_;
      split(corners, mesh_.triangles);
      group_.resize(mesh_.triangles.size(), entry->second);
    }
  }

  /// Of a file in pieces, scalars that all of them have.
  void add_scalars(std::vector<VertexScalar> piece) {
    if (first_point_ == 0) {
      scalars_ = std::move(piece);
      return;
    }
    std::erase_if(scalars_, [&](VertexScalar& scalar) {
      const auto same = std::find_if(piece.begin(), piece.end(),
                                     [&](const VertexScalar& p) { return p.name == scalar.name; });
      if (same == piece.end()) return true;
      scalar.values.insert(scalar.values.end(), same->values.begin(), same->values.end());
      return false;
    });
  }

  std::string name_of(const Kind& kind) const {
    return kind.surface < names_.size() ? names_[kind.surface] : std::string{};
  }

  const std::vector<std::string>& names_;
  Want want_;
  TriangleMesh mesh_;
  std::vector<VertexScalar> scalars_;
  std::uint32_t first_point_ = 0;
  std::vector<double> surfaces_;  // of this piece's cells
  std::vector<std::uint32_t> group_;
  std::map<Kind, std::uint32_t> numbers_;
  std::vector<Kind> kinds_;
};

SurfaceNote read_note(const Element& data, const std::string& file) {
  SurfaceNote note;
  const auto fields = data.child("FieldData");
  if (!fields) return note;
  for (VtkArray& array : fields->arrays()) {
    if (!array.is_text) continue;
    if (array.name == vtp_names_key) note.names = std::move(array.texts);
    else if (array.texts.size() == 1) apply_entry(array.name, array.texts[0], file, note);
  }
  return note;
}

}  // namespace

bool is_vtp(std::string_view content) {
  const std::string_view start = content.substr(0, 4096);
  return start.find("<VTKFile") != start.npos && start.find("PolyData") != start.npos;
}

ParsedFile parse_vtp(const std::string& file, std::string_view content, Want want) {
  const VtkXml xml(file, content, "PolyData");
  ParsedFile parsed;
  parsed.note = read_note(xml.data(), file);
  Triangles triangles(parsed.note.names, want);
  for (const Element& piece : xml.data().children("Piece")) triangles.add_piece(piece);
  parsed.bodies = triangles.bodies();
  parsed.note.names.clear();  // the bodies have them
  return parsed;
}

constexpr std::array vtp_forms{
    SurfaceFormat{.extension = ".vtp", .several = true, .scalars = true}};

constinit const MeshFormat vtp_format{
    .forms = vtp_forms,
    .is = is_vtp,
    .parse = [](const MeshSource& s) { return parse_vtp(s.file(), s.content, s.want); },
    .format =
        [](const std::filesystem::path& path, const SceneView& scene) {
          return one_file(path, format_vtp(path.string(), scene));
        },
    .needs_vtk = true};

}  // namespace surf::io
