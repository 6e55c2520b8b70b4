// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfSimplifyMesh.h"

#include <fmt/format.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>

#include <utility>

#include "attempt.h"
#include "convert/mesh.h"
#include "pipeline.h"
#include "property_values.h"
#include "reports.h"
#include "surf/core/error.h"
#include "surf/mesh/simplify_mesh.h"

vtkStandardNewMacro(vtkSemsurfSimplifyMesh);

using namespace surf;

vtkSemsurfSimplifyMesh::vtkSemsurfSimplifyMesh() : Values(std::make_unique<pv::PropertyValues>()) {}
vtkSemsurfSimplifyMesh::~vtkSemsurfSimplifyMesh() = default;

void vtkSemsurfSimplifyMesh::SetParameter(const char* name, double value) {
  if (this->Values->set(name, value)) this->Modified();
}

int vtkSemsurfSimplifyMesh::RequestInformation(vtkInformation*, vtkInformationVector**,
                                               vtkInformationVector* outputs) {
  return pv::announce_pieces(outputs->GetInformationObject(0));
}

int vtkSemsurfSimplifyMesh::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs,
                                                vtkInformationVector*) {
  pv::request_whole(inputs, 1);
  return 1;
}

int vtkSemsurfSimplifyMesh::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                        vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    vtkInformation* const output = outputs->GetInformationObject(0);
    if (!pv::is_first_piece(output)) return;
    if (this->Limit < ByTolerance || this->Limit > ByBoth)
      throw UsageError("Limit", fmt::format("there is no limit {}", this->Limit), "Choose 0 to 2");
    pv::PropertyValues values = *this->Values;
    if (this->Limit == ByTriangles) values.forget("mesh.mesh_tolerance");
    if (this->Limit == ByTolerance) values.forget("mesh.triangles");
    SimplifyOptions options;
    values.apply(options);
    // Corners at equal places are one, or seams would keep all of theirs.
    const TriangleMesh mesh =
        merge_equal_vertices(pv::to_mesh(pv::surface_input(inputs, 0), "Input"));
    if (!(length(bounds(mesh).size_nm()) > 0))
      throw InvalidInput("Input", "all its corners lie at one place", "Give a surface");
    constexpr double share = 1e-3;  // of the diagonal: no difference to be seen
    if (this->Limit != ByTriangles && options.tolerance_nm == 0)
      options.tolerance_nm = share * length(bounds(mesh).size_nm());
    SimplifiedMesh simple;
    pv::work(this, [&](const Watch& watch) {
      options.watch = watch;
      simple = simplify_mesh(mesh, options);
    });
    const SimplifySummary& summary = simple.summary;
    if (!summary.reached)
      pv::warn(this,
               fmt::format("Triangles: {} are left; fewer would {}", summary.triangles_after,
                           options.tolerance_nm > 0 ? "exceed Mesh Tolerance" : "turn faces over"));
    if (summary.end == SimplifyEnd::not_proven || !summary.deviation.proven())
      pv::warn(this, "Deviation: it is not proven, the coordinates may be too large");
    const auto data = pv::to_vtk(std::move(simple.mesh));
    pv::add_texts(data, {{"deviation_nm", fmt::format("{:.9g}", summary.deviation.largest_nm())}});
    pv::add_record(data, "mesh", record_of(options));
    pv::give(output, data);
  });
}
