// SPDX-License-Identifier: GPL-3.0-or-later
// Reads VTK's polygonal data as meshes, without VTK: its own reader crashes on damaged files.
#include <fmt/format.h>

#include <map>

#include "mesh_formats.h"
#include "split_mesh.h"
#include "surf/core/error.h"
#include "text_scanner.h"
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
      element->fail(fmt::format("{} cells are announced, and there are {}", count,
                                offsets->values.size()));
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
  static std::vector<std::string> texts(const Element& piece, const char* kind,
                                        std::size_t count) {
    const auto data = piece.child(kind);
    auto array = data ? data->array("material") : std::nullopt;
    if (!array || !array->is_text || array->texts.size() != count) return {};
    return std::move(array->texts);
  }

  std::vector<std::string> cells_;
  std::vector<std::string> points_;
};

/// Collects triangles and their materials.
class Triangles {
 public:
  void add_piece(const Element& piece) {
    const std::vector<Vec3> points = read_points(piece);
    first_point_ = static_cast<std::uint32_t>(mesh_.vertices_nm.size());
    if (mesh_.vertices_nm.size() + points.size() >= max_mesh_vertices) {
      piece.fail("the file has too many points");
    }
    const Cells polygons(piece, "Polys", "NumberOfPolys", points.size());
    const Cells strips(piece, "Strips", "NumberOfStrips", points.size());
    const std::uint64_t first = piece.count("NumberOfVerts") + piece.count("NumberOfLines");
    const Materials materials(piece, first + polygons.count() + strips.count(), points.size());
    mesh_.vertices_nm.insert(mesh_.vertices_nm.end(), points.begin(), points.end());
    add(polygons, first, materials, add_fan);
    add(strips, first + polygons.count(), materials, add_strip);
  }

  std::vector<NamedMesh> by_material() {
    std::vector<NamedMesh> result;
    if (names_.size() == 1) {   // the vertices keep their order
      result.push_back({{}, names_[0], std::move(mesh_)});
      return result;
    }
    std::vector<TriangleMesh> meshes = split_mesh(mesh_, group_, names_.size());
    for (std::size_t i = 0; i < names_.size(); ++i) {
      result.push_back({{}, names_[i], std::move(meshes[i])});
    }
    return result;
  }

 private:
  template <class Split>
  void add(const Cells& cells, std::size_t first_cell, const Materials& materials,
           const Split& split) {
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 0; i < cells.count(); ++i) {
      cells.get(i, corners);
      if (corners.size() < 3) continue;
      const auto [entry, is_new] = numbers_.try_emplace(
          materials.of(first_cell + i, corners[0]), static_cast<std::uint32_t>(names_.size()));
      if (is_new) names_.push_back(entry->first);
      for (std::uint32_t& corner : corners) corner += first_point_;
      split(corners, mesh_.triangles);
      group_.resize(mesh_.triangles.size(), entry->second);
    }
  }

  TriangleMesh mesh_;
  std::uint32_t first_point_ = 0;
  std::vector<std::uint32_t> group_;
  std::map<std::string, std::uint32_t> numbers_;
  std::vector<std::string> names_;
};

}  // namespace

bool is_vtp(std::string_view content) {
  const std::string_view start = content.substr(0, 4096);
  return start.find("<VTKFile") != start.npos && start.find("PolyData") != start.npos;
}

std::vector<NamedMesh> parse_vtp(const std::string& file, std::string_view content) {
  const VtkXml xml(file, content, "PolyData");
  Triangles triangles;
  for (const Element& piece : xml.data().children("Piece")) triangles.add_piece(piece);
  return triangles.by_material();
}

}  // namespace surf::io
