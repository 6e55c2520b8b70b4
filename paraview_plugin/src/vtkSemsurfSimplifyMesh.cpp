// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfSimplifyMesh.h"

#include <fmt/format.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>

#include <utility>

#include "attempt.h"
#include "checks.h"
#include "convert/mesh.h"
#include "pipeline.h"
#include "surf/core/error.h"
#include "surf/mesh/simplify_mesh.h"

vtkStandardNewMacro(vtkSemsurfSimplifyMesh);

using namespace surf;

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
    if (this->Limit != ByTriangles) pv::need_length(this->Tolerance, "Tolerance");
    if (this->Limit != ByTolerance && this->Triangles < 4)
      throw UsageError("Triangles", fmt::format("{} are too few for a body", this->Triangles),
                       "Give 4 or more");
    // Corners at equal places are one, or seams would keep all of theirs.
    const TriangleMesh mesh = merge_equal_vertices(pv::to_mesh(pv::surface_input(inputs, 0), "Input"));
    if (!(length(bounds(mesh).size_nm()) > 0))
      throw InvalidInput("Input", "all its corners lie at one place", "Give a surface");
    constexpr double share = 1e-3;   // of the diagonal: no difference to be seen
    SimplifyOptions options;
    if (this->Limit != ByTriangles)
      options.tolerance_nm = this->Tolerance > 0 ? this->Tolerance : share * length(bounds(mesh).size_nm());
    if (this->Limit != ByTolerance) options.triangles = static_cast<std::size_t>(this->Triangles);
    SimplifySummary summary;
    TriangleMesh simple;
    pv::work(this, [&](const Watch& watch) {
      options.watch = watch;
      simple = simplify_mesh(mesh, options, summary);
    });
    if (!summary.reached)
      pv::warn(this, fmt::format("Triangles: {} are left; fewer would {}", summary.triangles_after,
                                 options.tolerance_nm > 0 ? "exceed Tolerance" : "turn faces over"));
    const auto data = pv::to_vtk(std::move(simple));
    pv::add_texts(data, {{"deviation_nm", fmt::format("{:.9g}", summary.deviation.largest_nm())}});
    pv::give(output, data);
  });
}
