// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfSampleBody.h"

#include <fmt/format.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>

#include <utility>

#include "attempt.h"
#include "checks.h"
#include "convert/mesh.h"
#include "labels.h"
#include "pipeline.h"
#include "surf/core/error.h"
#include "surf/mesh/shapes.h"

vtkStandardNewMacro(vtkSemsurfSampleBody);

using namespace surf;

int vtkSemsurfSampleBody::RequestInformation(vtkInformation*, vtkInformationVector**,
                                             vtkInformationVector* outputs) {
  return pv::announce_pieces(outputs->GetInformationObject(0));
}

int vtkSemsurfSampleBody::RequestData(vtkInformation*, vtkInformationVector**,
                                      vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    vtkInformation* const output = outputs->GetInformationObject(0);
    if (!pv::is_first_piece(output)) return;
    for (const double nm : this->Base) pv::need_moderate(nm, "Base");
    const Vec3 base{this->Base[0], this->Base[1], this->Base[2]};
    TriangleMesh mesh;
    const auto make = [&] {
      switch (this->Shape) {
        case Box: {
          pv::need_within(this->Subdivisions, 1, 1000, "Subdivisions");
          for (const double nm : this->Size) pv::need_positive(nm, "Size");
          const Vec3 half{0.5 * this->Size[0], 0.5 * this->Size[1], 0};
          mesh = make_box(base - half, base + half + Vec3{0, 0, this->Size[2]}, this->Subdivisions);
          break;
        }
        case Sphere:
          mesh = make_sphere(base + Vec3{0, 0, this->Radius}, this->Radius, this->Subdivisions);
          break;
        case Cone:
          mesh = make_cone(base, this->Radius, this->TopRadius, this->ConeHeight, this->Segments);
          break;
        default:
          throw UsageError("Shape", fmt::format("there is no shape {}", this->Shape),
                           "Choose 0 to 2");
      }
    };
    pv::with_labels(make, {{"size of the box", "Size"},
                           {"subdivisions", "Subdivisions"},
                           {"radius", "Radius"},
                           {"bottom radius", "Radius"},
                           {"top radius", "Top Radius"},
                           {"segments", "Segments"},
                           {"height of the cone", "Cone Height"}});
    pv::give(output, pv::to_vtk(std::move(mesh)));
  });
}
