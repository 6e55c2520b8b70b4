// SPDX-License-Identifier: GPL-3.0-or-later
#include "convert/mesh.h"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <set>

#include "convert/arrays.h"
#include "surf/core/error.h"

namespace surf::pv {
namespace {

// What lets VTK take the memory over as it is.
static_assert(sizeof(Vec3) == 3 * sizeof(double) && alignof(Vec3) == alignof(double));
static_assert(sizeof(Triangle) == 3 * sizeof(std::uint32_t));

std::vector<Vec3> vertices_of(vtkPolyData* data) {
  std::vector<Vec3> vertices(static_cast<std::size_t>(data->GetNumberOfPoints()));
  if (vertices.empty()) return vertices;
  vtkDataArray* const points = data->GetPoints()->GetData();
  const auto copy = [&](const auto* value) {
    for (Vec3& v : vertices) {
      v = {double(value[0]), double(value[1]), double(value[2])};
      value += 3;
    }
  };
  if (auto* doubles = vtkDoubleArray::FastDownCast(points)) copy(doubles->GetPointer(0));
  else if (auto* floats = vtkFloatArray::FastDownCast(points)) copy(floats->GetPointer(0));
  else
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      double p[3];
      points->GetTuple(vtkIdType(i), p);
      vertices[i] = {p[0], p[1], p[2]};
    }
  return vertices;
}

template <class Add>
void for_each_cell(vtkCellArray* cells, const Add& add) {
  const auto cell = vtk::TakeSmartPointer(cells->NewIterator());
  for (cell->GoToFirstCell(); !cell->IsDoneWithTraversal(); cell->GoToNextCell()) {
    vtkIdType count = 0;
    const vtkIdType* points = nullptr;
    cell->GetCurrentCell(count, points);
    add(count, points);
  }
}

Triangle triangle(vtkIdType a, vtkIdType b, vtkIdType c) {
  return {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
          static_cast<std::uint32_t>(c)};
}

std::vector<Triangle> triangles_of(vtkPolyData* data) {
  std::vector<Triangle> triangles;
  triangles.reserve(static_cast<std::size_t>(data->GetNumberOfPolys()));
  for_each_cell(data->GetPolys(), [&](vtkIdType count, const vtkIdType* p) {
    for (vtkIdType k = 2; k < count; ++k) triangles.push_back(triangle(p[0], p[k - 1], p[k]));
  });
  for_each_cell(data->GetStrips(), [&](vtkIdType count, const vtkIdType* p) {
    for (vtkIdType k = 2; k < count; ++k)  // every second one runs the other way
      triangles.push_back(k % 2 == 0 ? triangle(p[k - 2], p[k - 1], p[k])
                                     : triangle(p[k - 1], p[k - 2], p[k]));
  });
  return triangles;
}

std::string unit_of(vtkDataArray* array) {
  vtkInformation* const keys = array->GetInformation();
  return keys->Has(vtkDataArray::UNITS_LABEL()) ? keys->Get(vtkDataArray::UNITS_LABEL()) : "1";
}

}  // namespace

TriangleMesh to_mesh(vtkPolyData* data, const char* subject) {
  // A triangle's corners are 32-bit numbers, and VTK's are signed.
  if (data->GetNumberOfPoints() > vtkIdType{1} << 31)
    throw InvalidInput(subject, fmt::format("it has {} points", data->GetNumberOfPoints()),
                       "Simplify it first");
  TriangleMesh mesh{vertices_of(data), triangles_of(data)};
  if (mesh.triangles.empty())
    throw InvalidInput(subject, "it has no polygons",
                       "Give a surface: 'Extract Surface' makes one of cells");
  validate(mesh, subject);
  constexpr double most_nm = 1e12;
  for (const Vec3& v : mesh.vertices_nm)
    if (const double far = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); far > most_nm)
      throw InvalidInput(subject, fmt::format("it reaches as far as {:.3g} nm", far),
                         "Lengths are nm: 'Transform' scales and moves it");
  return mesh;
}

Surface to_surface(vtkPolyData* data, const char* subject) {
  Surface surface{.name = "surface", .mesh = to_mesh(data, subject), .scalars = {}, .drape = {}};
  std::set<std::string> names;
  vtkPointData* const arrays = data->GetPointData();
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i) {
    vtkDataArray* const array = arrays->GetArray(i);
    if (!array || !array->GetName() || array->GetNumberOfComponents() != 1) continue;
    if (std::string(array->GetName()) == "vtkGhostType") continue;
    VertexScalar scalar{scalar_name(array->GetName()), unit_of(array), {}};
    for (const double value : values_of(array)) scalar.values.push_back(static_cast<float>(value));
    const auto finite = [](float value) { return std::isfinite(value); };
    if (std::ranges::all_of(scalar.values, finite) && names.insert(scalar.name).second)
      surface.scalars.push_back(std::move(scalar));
  }
  return surface;
}

vtkSmartPointer<vtkPolyData> to_vtk(TriangleMesh mesh) {
  using Vertices = std::vector<Vec3>;
  using Triangles = std::vector<Triangle>;
  const auto values = static_cast<vtkIdType>(3 * mesh.vertices_nm.size());
  const auto corners = static_cast<vtkIdType>(3 * mesh.triangles.size());
  std::vector<std::int32_t> starts(mesh.triangles.size() + 1);
  for (std::size_t i = 0; i < starts.size(); ++i) starts[i] = static_cast<std::int32_t>(3 * i);

  const auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  points->SetData(TakenArray<vtkDoubleArray, Vertices>::make<double>(
      std::move(mesh.vertices_nm), [](Vertices& v) { return reinterpret_cast<double*>(v.data()); },
      values, 3));
  const auto polygons = vtkSmartPointer<vtkCellArray>::New();
  polygons->SetData(
      take_array<vtkTypeInt32Array>(std::move(starts), ""),
      TakenArray<vtkTypeInt32Array, Triangles>::make<std::int32_t>(
          std::move(mesh.triangles),
          [](Triangles& t) { return reinterpret_cast<std::int32_t*>(t.data()); }, corners, 1));
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(polygons);
  return data;
}

vtkSmartPointer<vtkPolyData> to_vtk(Surface surface) {
  auto data = to_vtk(std::move(surface.mesh));
  vtkPointData* const arrays = data->GetPointData();
  for (VertexScalar& scalar : surface.scalars) {
    auto array = take_array<vtkFloatArray>(std::move(scalar.values), scalar.name);
    set_unit(array, scalar.unit.c_str());
    arrays->AddArray(array);
    if (!arrays->GetScalars() || scalar.name == "height")
      arrays->SetActiveScalars(scalar.name.c_str());
  }
  return data;
}

}  // namespace surf::pv
