// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes as VTK's polygonal data.
#include "vtp_write.h"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataWriter.h>

#include <algorithm>

#include "surf/core/error.h"
#include "surf/mesh/vertex_normals.h"
#include "vtk_functions.h"
#include "vtk_support.h"
#include "vtp_format.h"

namespace surf::io::vtk {
namespace {

void add_triangles(vtkPolyData* data, const SceneView& scene) {
  std::size_t vertices = 0, triangles = 0;
  for (const SurfaceView& surface : scene.surfaces) {
    vertices += surface.mesh->vertices_nm.size();
    triangles += surface.mesh->triangles.size();
  }
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(vertices));
  vtkNew<vtkCellArray> polygons;
  // Half the bytes to compress, and to read.
  if (3 * triangles < (std::size_t{1} << 31) && vertices < (std::size_t{1} << 31))
    polygons->Use32BitStorage();
  polygons->AllocateExact(static_cast<vtkIdType>(triangles), static_cast<vtkIdType>(3 * triangles));
  vtkNew<vtkIntArray> surfaces;
  surfaces->SetName("surface");
  surfaces->SetNumberOfValues(static_cast<vtkIdType>(triangles));
  vtkIdType first = 0, cell = 0;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const TriangleMesh& mesh = *scene.surfaces[s].mesh;
    for (std::size_t i = 0; i < mesh.vertices_nm.size(); ++i) {
      const Vec3 v = scene.note.to_file(mesh.vertices_nm[i]);
      points->SetPoint(first + static_cast<vtkIdType>(i), v.x, v.y, v.z);
    }
    for (const Triangle& t : mesh.triangles) {
      polygons->InsertNextCell({first + t[0], first + t[1], first + t[2]});
      surfaces->SetValue(cell++, static_cast<int>(s));
    }
    first += static_cast<vtkIdType>(mesh.vertices_nm.size());
  }
  data->SetPoints(points);
  data->SetPolys(polygons);
  if (scene.surfaces.size() > 1) data->GetCellData()->AddArray(surfaces);
}

vtkNew<vtkFloatArray> point_array(vtkPolyData* data, const char* name, int components) {
  vtkNew<vtkFloatArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(data->GetNumberOfPoints());
  return array;
}

/// Those that all surfaces have, "height" or else the first being the one that is shown.
void add_scalars(vtkPolyData* data, const SceneView& scene) {
  for (const auto& scalar : common_scalars(scene)) {
    const std::string& name = scalar.front()->name;
    const auto array = point_array(data, name.c_str(), 1);
    array->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), scalar.front()->unit.c_str());
    float* place = array->GetPointer(0);
    for (const VertexScalar* part : scalar) {
      place = std::copy(part->values.begin(), part->values.end(), place);
    }
    vtkPointData* const points = data->GetPointData();
    points->AddArray(array);
    if (!points->GetScalars() || name == "height") points->SetActiveScalars(name.c_str());
  }
}

void add_normals(vtkPolyData* data, const SceneView& scene) {
  const auto array = point_array(data, "Normals", 3);
  float* place = array->GetPointer(0);
  for (const SurfaceView& surface : scene.surfaces) {
    for (const Vec3& n : vertex_normals(*surface.mesh)) {
      for (const double value : {n.x, n.y, n.z}) *place++ = static_cast<float>(value);
    }
  }
  data->GetPointData()->SetNormals(array);
}

/// Where pictures lie, so that ParaView can lay them on as a texture.
void add_texture_points(vtkPolyData* data, const SceneView& scene) {
  if (!std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                   [](const SurfaceView& surface) { return surface.drape != nullptr; })) {
    return;
  }
  const auto array = point_array(data, "TCoords", 2);
  float* place = array->GetPointer(0);
  for (const SurfaceView& surface : scene.surfaces) {
    for (const Vec3& v : surface.mesh->vertices_nm) {
      const TexturePoint p = surface.drape ? texture_point(*surface.drape, v) : TexturePoint{};
      *place++ = static_cast<float>(p.u);
      *place++ = static_cast<float>(p.v);
    }
  }
  data->GetPointData()->SetTCoords(array);
}

void add_notes(vtkPolyData* data, const SceneView& scene) {
  SurfaceNote note = scene.note;
  note.names.clear();  // as one array
  for (const auto& [key, value] : to_entries(note, false))
    add_text(data->GetFieldData(), key, value);
  vtkNew<vtkStringArray> names;
  names->SetName(vtp_names_key);
  for (const SurfaceView& surface : scene.surfaces)
    names->InsertNextValue(std::string(surface.name));
  data->GetFieldData()->AddArray(names);
}

}  // namespace

std::string format_vtp(const std::string& file, const SceneView& scene) {
  vtkNew<vtkPolyData> data;
  add_triangles(data, scene);
  add_scalars(data, scene);
  add_normals(data, scene);
  add_texture_points(data, scene);
  add_notes(data, scene);
  return vtp_content(file, data);
}

std::string vtp_content(const std::string& file, vtkPolyData* data) {
  VtkComplaints complaints;
  vtkNew<vtkXMLPolyDataWriter> writer;
  complaints.listen_to(writer.GetPointer());
  writer->SetInputData(data);
  writer->SetDataModeToBinary();  // ParaView 5.11 on Debian 12 cannot read appended data
  writer->WriteToOutputStringOn();
  writer->SetCompressionLevel(1);  // fast rather than small
  if (writer->Write() != 1 || !complaints.text().empty()) {
    throw FileError(file, fmt::format("it cannot be written: {}", complaints.text()),
                    "Check the memory, or choose another format");
  }
  return writer->GetOutputString();
}

}  // namespace surf::io::vtk
