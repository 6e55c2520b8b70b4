// SPDX-License-Identifier: GPL-3.0-or-later
#include "convert/tracks.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkTypeInt64Array.h>

#include "convert/arrays.h"

namespace surf::pv {
namespace {

template <class Array, class Value>
void add_line_array(vtkPolyData* data, const char* name, const std::vector<Track>& tracks,
                    const Value& value) {
  vtkNew<Array> array;
  array->SetName(name);
  for (const Track& track : tracks) array->InsertNextValue(value(track));
  data->GetCellData()->AddArray(array);
}

}  // namespace

vtkSmartPointer<vtkPolyData> to_vtk(const std::vector<Track>& tracks) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  std::vector<double> energies;
  std::vector<int> materials;
  for (const Track& track : tracks) {
    lines->InsertNextCell(static_cast<int>(track.points_nm.size()));
    for (std::size_t i = 0; i < track.points_nm.size(); ++i) {
      const Vec3& p = track.points_nm[i];
      lines->InsertCellPoint(points->InsertNextPoint(p.x, p.y, p.z));
      energies.push_back(track.energy_ev[i]);
      materials.push_back(track.material[i == 0 ? 0 : i - 1]);
    }
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetLines(lines);
  const auto energy = take_array<vtkDoubleArray>(std::move(energies), "energy_ev");
  set_unit(energy, "eV");
  data->GetPointData()->AddArray(energy);
  data->GetPointData()->SetActiveScalars("energy_ev");
  data->GetPointData()->AddArray(take_array<vtkIntArray>(std::move(materials), "material"));
  add_line_array<vtkIntArray>(data, "kind", tracks,
                              [](const Track& t) { return static_cast<int>(t.kind); });
  add_line_array<vtkIntArray>(data, "secondary", tracks,
                              [](const Track& t) { return t.secondary ? 1 : 0; });
  add_line_array<vtkIntArray>(data, "generation", tracks,
                              [](const Track& t) { return t.generation; });
  add_line_array<vtkTypeInt64Array>(data, "electron", tracks,
                                    [](const Track& t) { return t.electron; });
  add_line_array<vtkIntArray>(data, "number", tracks, [](const Track& t) { return t.number; });
  add_line_array<vtkIntArray>(data, "parent", tracks, [](const Track& t) { return t.parent; });
  return data;
}

}  // namespace surf::pv
