// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfRepairMesh.h"

#include <fmt/format.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkTable.h>

#include <utility>

#include "attempt.h"
#include "convert/mesh.h"
#include "convert/table.h"
#include "pipeline.h"
#include "property_values.h"
#include "reports.h"
#include "surf/core/error.h"
#include "surf/mesh/repair_mesh.h"
#include "surf/mesh/self_intersections.h"

vtkStandardNewMacro(vtkSemsurfRepairMesh);

using namespace surf;

namespace {

void add_report(vtkTable* table, const RepairSummary& s) {
  std::vector<std::string> names;
  std::vector<double> before, after;
  const auto add = [&](const char* name, auto value) {
    names.push_back(name);
    before.push_back(static_cast<double>(value(s.before)));
    after.push_back(static_cast<double>(value(s.after)));
  };
  add("vertices", [](const MeshReport& r) { return r.vertices; });
  add("triangles", [](const MeshReport& r) { return r.triangles; });
  add("degenerate_triangles", [](const MeshReport& r) { return r.degenerate_triangles; });
  add("duplicate_triangles", [](const MeshReport& r) { return r.duplicate_triangles; });
  add("boundary_edges", [](const MeshReport& r) { return r.boundary_edges; });
  add("nonmanifold_edges", [](const MeshReport& r) { return r.nonmanifold_edges; });
  add("nonmanifold_vertices", [](const MeshReport& r) { return r.nonmanifold_vertices; });
  add("inconsistent_edges", [](const MeshReport& r) { return r.inconsistent_edges; });
  add("components", [](const MeshReport& r) { return r.components; });
  add("closed_and_oriented", [](const MeshReport& r) { return r.closed_and_oriented ? 1 : 0; });
  add("area_nm2", [](const MeshReport& r) { return r.area_nm2; });
  add("signed_volume_nm3", [](const MeshReport& r) { return r.signed_volume_nm3; });
  names.push_back("self_intersections");
  before.push_back(static_cast<double>(s.self_intersections_before));
  after.push_back(static_cast<double>(s.self_intersections_after));
  pv::add_column(table, "quantity", names);
  pv::add_column(table, "before", std::move(before));
  pv::add_column(table, "after", std::move(after));
}

}  // namespace

vtkSemsurfRepairMesh::vtkSemsurfRepairMesh() : Values(std::make_unique<pv::PropertyValues>()) {
  this->SetNumberOfOutputPorts(2);
}
vtkSemsurfRepairMesh::~vtkSemsurfRepairMesh() = default;

void vtkSemsurfRepairMesh::SetParameter(const char* name, double value) {
  if (this->Values->set(name, value)) this->Modified();
}

int vtkSemsurfRepairMesh::FillOutputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkPolyData" : "vtkTable");
  return 1;
}

int vtkSemsurfRepairMesh::RequestInformation(vtkInformation*, vtkInformationVector**,
                                             vtkInformationVector* outputs) {
  pv::announce_pieces(outputs->GetInformationObject(0));
  return pv::announce_pieces(outputs->GetInformationObject(1));
}

int vtkSemsurfRepairMesh::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs,
                                              vtkInformationVector*) {
  pv::request_whole(inputs, 1);
  return 1;
}

int vtkSemsurfRepairMesh::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                      vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    if (!pv::is_first_piece(outputs->GetInformationObject(0))) return;
    RepairOptions options;
    this->Values->apply(options);
    vtkPolyData* const input = pv::surface_input(inputs, 0);
    const TriangleMesh mesh = pv::to_mesh(input, "Input");
    RepairedMesh mended;
    RepairSummary& summary = mended.summary;
    pv::work(this, [&](const Watch& watch) {
      if (!this->Repair) {
        summary.before = summary.after = check_mesh(mesh, watch.part(0, 0.3));
        summary.self_intersections_before = summary.self_intersections_after =
            find_self_intersections(mesh, {.watch = watch.part(0.3, 1)}).pairs.size();
        return;
      }
      options.watch = watch;
      mended = repair_mesh(mesh, options);
    });
    vtkNew<vtkTable> table;
    add_report(table, summary);
    // Unchanged, it keeps what lies on it.
    if (summary.changed)
      pv::give(outputs->GetInformationObject(0), pv::to_vtk(std::move(mended.mesh)));
    else pv::give(outputs->GetInformationObject(0), input);
    if (this->Repair) pv::add_record(table, "mesh", record_of(options));
    pv::give(outputs->GetInformationObject(1), table);
  });
}
