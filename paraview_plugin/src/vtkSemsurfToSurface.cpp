// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfToSurface.h"

#include <fmt/format.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>

#include <algorithm>
#include <utility>

#include "attempt.h"
#include "checks.h"
#include "convert/mesh.h"
#include "pipeline.h"
#include "surf/core/error.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/sheet_solid.h"
#include "surf/mesh/thin_height_field.h"
#include "surf/mesh/vertex_curvature.h"

vtkStandardNewMacro(vtkSemsurfToSurface);

using namespace surf;

int vtkSemsurfToSurface::FillInputPortInformation(int, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

int vtkSemsurfToSurface::RequestInformation(vtkInformation*, vtkInformationVector**,
                                            vtkInformationVector* outputs) {
  return pv::announce_pieces(outputs->GetInformationObject(0));
}

int vtkSemsurfToSurface::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs,
                                             vtkInformationVector*) {
  pv::request_whole(inputs, 1);
  return 1;
}

int vtkSemsurfToSurface::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                     vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    vtkInformation* const output = outputs->GetInformationObject(0);
    if (!pv::is_first_piece(output)) return;
    if (this->Simplify) pv::need_length(this->Tolerance, "Tolerance");
    if (this->Simplify && (this->MaximumTriangles < 0 || this->MaximumTriangles == 1))
      throw UsageError("Maximum Triangles",
                       fmt::format("{} is not 0, nor 2 or more", this->MaximumTriangles),
                       "Give 0 for no limit");
    pv::need_length(this->Thickness, "Thickness");
    vtkImageData* const image = pv::image_input(inputs, 0, "Input");
    const HeightField field = pv::to_height_field(image, pv::chosen_array(this, 0, image), "Input");
    Surface surface;
    ThinSheet thin;
    pv::work(this, [&](const Watch& watch) {
      if (this->Simplify) {
        thin =
            thin_height_field(field, {.tolerance_nm = this->Tolerance,
                                      .triangles = static_cast<std::size_t>(this->MaximumTriangles),
                                      .watch = watch.part(0, 0.8)});
        surface.mesh = std::move(thin.mesh);
      } else {
        surface.mesh = height_field_sheet(field);
      }
      // Thinning takes most of the time, where there is any.
      const double curvature_from = this->Simplify ? 0.8 : 0.1;
      watch.report(curvature_from, 1);
      // Of the sheet: at walls and corners it would be infinite.
      VertexScalar curvature{"curvature", "1/nm", {}};
      if (this->Curvature)
        curvature.values = mean_curvature(surface.mesh, 0, watch.part(curvature_from, 0.9));
      watch.report(0.9, 1);
      if (this->Solid) {
        constexpr double base_share = 0.05;  // of the longer side, as of 'semsurf mesh'
        const Box box = bounds(surface.mesh);
        const double depth_nm = this->Thickness > 0
                                    ? this->Thickness
                                    : base_share * std::max(box.size_nm().x, box.size_nm().y);
        surface.mesh = sheet_solid(surface.mesh, box.lower_nm.z - depth_nm, watch.part(0.9, 0.98));
      }
      VertexScalar height{"height", "nm", {}};
      height.values.reserve(surface.mesh.vertices_nm.size());
      for (const Vec3& v : surface.mesh.vertices_nm)
        height.values.push_back(static_cast<float>(v.z));
      surface.scalars.push_back(std::move(height));
      if (!this->Curvature) return;
      curvature.values.resize(surface.mesh.vertices_nm.size(), 0);  // the walls' feet
      surface.scalars.push_back(std::move(curvature));
    });
    if (!thin.summary.reached)
      pv::warn(this,
               fmt::format("with {} triangles the surface is {:.4g} nm off, more than Tolerance",
                           thin.summary.triangles_after, thin.summary.deviation_nm));
    pv::give(output, pv::to_vtk(std::move(surface)));
  });
}
