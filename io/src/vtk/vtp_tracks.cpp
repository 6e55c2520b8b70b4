// SPDX-License-Identifier: GPL-3.0-or-later
// Electron tracks as VTK's polylines.
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTypeInt64Array.h>

#include "vtk_functions.h"
#include "vtk_support.h"
#include "vtp_format.h"
#include "vtp_write.h"

namespace surf::io::vtk {
namespace {

/// One number per track, got by `value`.
template <class Array, class Value>
void add_cell_array(vtkPolyData* data, const char* name, std::span<const Track> tracks,
                    const Value& value) {
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfTuples(static_cast<vtkIdType>(tracks.size()));
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    array->SetValue(static_cast<vtkIdType>(i), value(tracks[i]));
  }
  data->GetCellData()->AddArray(array);
}

void add_lines(vtkPolyData* data, std::span<const Track> tracks) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  vtkNew<vtkDoubleArray> energies;
  energies->SetName("energy_ev");
  vtkNew<vtkIntArray> materials;
  materials->SetName("material");
  for (const Track& track : tracks) {
    lines->InsertNextCell(static_cast<int>(track.points_nm.size()));
    for (std::size_t i = 0; i < track.points_nm.size(); ++i) {
      const Vec3& p = track.points_nm[i];
      lines->InsertCellPoint(points->InsertNextPoint(p.x, p.y, p.z));
      energies->InsertNextValue(track.energy_ev[i]);
      materials->InsertNextValue(track.material[i == 0 ? 0 : i - 1]);
    }
  }
  data->SetPoints(points);
  data->SetLines(lines);
  data->GetPointData()->AddArray(energies);
  data->GetPointData()->AddArray(materials);
}

}  // namespace

std::string format_tracks(const std::string& file, std::span<const Track> tracks,
                          const std::map<std::string, std::string>& metadata) {
  vtkNew<vtkPolyData> data;
  add_lines(data, tracks);
  add_cell_array<vtkIntArray>(data, "kind", tracks,
                              [](const Track& t) { return static_cast<int>(t.kind); });
  add_cell_array<vtkIntArray>(data, "secondary", tracks,
                              [](const Track& t) { return t.secondary ? 1 : 0; });
  add_cell_array<vtkIntArray>(data, "generation", tracks,
                              [](const Track& t) { return t.generation; });
  add_cell_array<vtkTypeInt64Array>(data, "electron", tracks,
                                    [](const Track& t) { return t.electron; });
  add_cell_array<vtkIntArray>(data, "number", tracks, [](const Track& t) { return t.number; });
  add_cell_array<vtkIntArray>(data, "parent", tracks, [](const Track& t) { return t.parent; });
  for (const auto& [key, value] : metadata) add_text(data->GetFieldData(), key, value);
  return vtp_content(file, data);
}

}  // namespace surf::io::vtk
