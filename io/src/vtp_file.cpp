// SPDX-License-Identifier: GPL-3.0-or-later
// VTK's polygonal data as meshes.
#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <map>

#include "mesh_formats.h"
#include "split_mesh.h"
#include "surf/core/error.h"
#include "vtk_support.h"
#include "vtp_format.h"
#include "vtp_write.h"

namespace surf::io {
namespace {

/// The cells of one kind, from arrays that nobody has checked.
class Cells {
 public:
  Cells(vtkCellArray* cells, vtkIdType points, const char* what, const std::string& file) {
    if (!cells || cells->GetNumberOfCells() == 0) return;
    offsets_ = cells->GetOffsetsArray();
    corners_ = cells->GetConnectivityArray();
    count_ = offsets_->GetNumberOfTuples() - 1;
    const auto refuse = [&](const std::string& reason) {
      throw FileError(file, fmt::format("its {} are damaged: {}", what, reason),
                      "Copy or write it again");
    };
    for (vtkIdType i = 0; i < count_; ++i) {
      if (offset(i) < 0 || offset(i + 1) < offset(i)) refuse("the offsets do not rise");
    }
    if (offset(count_) > corners_->GetNumberOfTuples()) refuse("there are too few corners");
    for (vtkIdType i = 0; i < corners_->GetNumberOfTuples(); ++i) {
      if (corner(i) >= 0 && corner(i) < points) continue;
      refuse(fmt::format("a corner names point {} of {}", corner(i), points));
    }
  }

  vtkIdType count() const { return count_; }

  void get(vtkIdType cell, std::vector<std::uint32_t>& corners) const {
    corners.clear();
    for (vtkIdType i = offset(cell); i < offset(cell + 1); ++i) {
      corners.push_back(static_cast<std::uint32_t>(corner(i)));
    }
  }

 private:
  vtkIdType offset(vtkIdType i) const { return static_cast<vtkIdType>(offsets_->GetComponent(i, 0)); }
  vtkIdType corner(vtkIdType i) const { return static_cast<vtkIdType>(corners_->GetComponent(i, 0)); }

  vtkDataArray* offsets_ = nullptr;
  vtkDataArray* corners_ = nullptr;
  vtkIdType count_ = 0;
};

std::vector<Vec3> read_points(vtkPolyData* data, const std::string& file) {
  std::vector<Vec3> points(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    double p[3];
    data->GetPoint(static_cast<vtkIdType>(i), p);
    points[i] = {p[0], p[1], p[2]};
    if (is_finite(points[i])) continue;
    throw FileError(file, fmt::format("point {} is not finite", i),
                    "Repair the mesh or export it again");
  }
  return points;
}

/// Which material a cell is of, as far as the file says so in texts.
class Materials {
 public:
  explicit Materials(vtkPolyData* data)
      : cells_(texts(data->GetCellData(), data->GetNumberOfCells())),
        points_(texts(data->GetPointData(), data->GetNumberOfPoints())) {}

  std::string of(vtkIdType cell, vtkIdType first_corner) const {
    if (cells_) return cells_->GetValue(cell);
    return points_ ? std::string(points_->GetValue(first_corner)) : std::string{};
  }

 private:
  static vtkStringArray* texts(vtkFieldData* fields, vtkIdType count) {
    auto* const array = vtkStringArray::SafeDownCast(fields->GetAbstractArray("material"));
    return array && array->GetNumberOfValues() == count ? array : nullptr;
  }

  vtkStringArray* cells_;
  vtkStringArray* points_;
};

/// Collects triangles and their materials.
class Triangles {
 public:
  explicit Triangles(std::vector<Vec3> points) : mesh_{std::move(points), {}} {}

  template <class Split>
  void add(const Cells& cells, vtkIdType first_cell, const Materials& materials,
           const Split& split) {
    std::vector<std::uint32_t> corners;
    for (vtkIdType i = 0; i < cells.count(); ++i) {
      cells.get(i, corners);
      if (corners.size() < 3) continue;
      split(corners, mesh_.triangles);
      const auto [entry, is_new] = numbers_.try_emplace(
          materials.of(first_cell + i, corners[0]), static_cast<std::uint32_t>(names_.size()));
      if (is_new) names_.push_back(entry->first);
      group_.resize(mesh_.triangles.size(), entry->second);
    }
  }

  std::vector<NamedMesh> by_material() {
    std::vector<NamedMesh> result;
    if (names_.size() == 1) return {{{}, names_[0], std::move(mesh_)}};
    std::vector<TriangleMesh> meshes = split_mesh(mesh_, group_, names_.size());
    for (std::size_t i = 0; i < names_.size(); ++i) {
      result.push_back({{}, names_[i], std::move(meshes[i])});
    }
    return result;
  }

 private:
  TriangleMesh mesh_;
  std::vector<std::uint32_t> group_;
  std::map<std::string, std::uint32_t> numbers_;
  std::vector<std::string> names_;
};

}  // namespace

bool has_vtp() { return true; }

std::vector<NamedMesh> parse_vtp(const std::string& file, std::string_view content) {
  // This VTK reads appended data as nothing at all, without a word (its XML parser's fault).
  if (content.find("<AppendedData") != std::string_view::npos) {
    throw FileError(file, "its data is appended, which cannot be read here",
                    "Save it with the data mode Binary or Ascii");
  }
  VtkComplaints complaints;
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetReaderErrorObserver(complaints.command());
  reader->SetParserErrorObserver(complaints.command());
  complaints.listen_to(reader.GetPointer());
  reader->ReadFromInputStringOn();
  reader->SetInputString(std::string(content));
  reader->Update();
  if (!complaints.text().empty() || reader->GetErrorCode() != 0) {
    throw FileError(file, fmt::format("cannot be read as VTP: {}", complaints.text()),
                    "It is cut off or damaged: copy or write it again");
  }
  vtkPolyData* const data = reader->GetOutput();
  const vtkIdType points = data->GetNumberOfPoints();
  const Cells polygons(data->GetPolys(), points, "polygons", file);
  const Cells strips(data->GetStrips(), points, "strips", file);
  const vtkIdType first_polygon = data->GetNumberOfVerts() + data->GetNumberOfLines();
  const Materials materials(data);
  Triangles triangles(read_points(data, file));
  triangles.add(polygons, first_polygon, materials, add_fan);
  triangles.add(strips, first_polygon + polygons.count(), materials, add_strip);
  return triangles.by_material();
}

std::string format_vtp(const std::string& file, const TriangleMesh& mesh) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.vertices_nm.size()));
  for (std::size_t i = 0; i < mesh.vertices_nm.size(); ++i) {
    const Vec3& v = mesh.vertices_nm[i];
    points->SetPoint(static_cast<vtkIdType>(i), v.x, v.y, v.z);
  }
  vtkNew<vtkCellArray> polygons;
  for (const Triangle& t : mesh.triangles) {
    polygons->InsertNextCell({vtkIdType{t[0]}, vtkIdType{t[1]}, vtkIdType{t[2]}});
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(polygons);
  return vtp_content(file, data);
}

std::string vtp_content(const std::string& file, vtkPolyData* data) {
  VtkComplaints complaints;
  vtkNew<vtkXMLPolyDataWriter> writer;
  complaints.listen_to(writer.GetPointer());
  writer->SetInputData(data);
  writer->SetDataModeToBinary();   // ParaView 5.11 on Debian 12 cannot read appended data
  writer->WriteToOutputStringOn();
  if (writer->Write() != 1 || !complaints.text().empty()) {
    throw FileError(file, fmt::format("cannot be written: {}", complaints.text()),
                    "Check the memory, or choose another format");
  }
  return writer->GetOutputString();
}

}  // namespace surf::io
