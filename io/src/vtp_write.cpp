// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes as VTK's polygonal data.
#include "vtp_write.h"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataWriter.h>

#include "surf/core/error.h"
#include "vtk_support.h"
#include "vtp_format.h"

namespace surf::io {

bool has_vtp_writer() { return true; }

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
