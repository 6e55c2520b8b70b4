// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfToHeightField.h"

#include <fmt/format.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "attempt.h"
#include "convert/mesh.h"
#include "pipeline.h"
#include "surf/core/error.h"
#include "surf/mesh/mesh_height_field.h"

vtkStandardNewMacro(vtkSemsurfToHeightField);

using namespace surf;

int vtkSemsurfToHeightField::FillInputPortInformation(int, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  return 1;
}

double vtkSemsurfToHeightField::PitchFor(double width_nm, double depth_nm) const {
  if (!(width_nm > 0 && depth_nm > 0 && std::isfinite(width_nm + depth_nm)))
    throw InvalidInput("Input",
                       fmt::format("seen from above it is {} x {} nm large", width_nm, depth_nm),
                       "Give a surface that covers an area: 'Transform' turns it");
  constexpr int most = 16384;
  if (this->Pitch == 0) {
    if (this->Samples < 2 || this->Samples > most)
      throw UsageError("Samples", fmt::format("{} is not in 2 to {}", this->Samples, most),
                       "Give 256 where in doubt");
    return std::max(width_nm, depth_nm) / (this->Samples - 1);
  }
  if (!(this->Pitch > 0 && this->Pitch <= 2 * std::min(width_nm, depth_nm) &&
        this->Pitch * (most - 1) >= std::max(width_nm, depth_nm)))
    throw UsageError(
        "Pitch",
        fmt::format("with {} nm there are no 2 to {} samples across {:.4g} x {:.4g} nm",
                    this->Pitch, most, width_nm, depth_nm),
        "Give 0 to go by Samples");
  return this->Pitch;
}

/// How large the image becomes depends on the surface, so that has to be made before anything is
/// said of it.
int vtkSemsurfToHeightField::RequestInformation(vtkInformation*, vtkInformationVector**,
                                                vtkInformationVector* outputs) {
  return pv::attempt_information(this, outputs, [&] {
    int port = 0;
    vtkAlgorithm* const producer = this->GetInputAlgorithm(0, 0, port);
    producer->UpdatePiece(0, 1, 0);
    auto* const data = vtkPolyData::SafeDownCast(producer->GetOutputDataObject(port));
    if (!data || data->GetNumberOfPoints() == 0)
      throw InvalidInput("Input", "it has no points", "Give a surface");
    double b[6];
    data->GetPoints()->GetBounds(b);
    const double pitch = this->PitchFor(b[1] - b[0], b[3] - b[2]);
    const auto samples = [&](double length) {
      return static_cast<int>(std::round(length / pitch)) + 1;
    };
    pv::announce(outputs->GetInformationObject(0),
                 {{pitch, pitch, b[0], b[2]}, samples(b[1] - b[0]), samples(b[3] - b[2])});
  });
}

int vtkSemsurfToHeightField::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs,
                                                 vtkInformationVector*) {
  pv::request_whole(inputs, 1);
  return 1;
}

int vtkSemsurfToHeightField::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                         vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    const TriangleMesh mesh = pv::to_mesh(pv::surface_input(inputs, 0), "Input");
    const Vec3 size = bounds(mesh).size_nm();
    HeightField field;
    pv::work(this, [&](const Watch& watch) {
      field = mesh_height_field(mesh, {.pitch_nm = this->PitchFor(size.x, size.y), .watch = watch});
    });
    pv::give(outputs->GetInformationObject(0), pv::to_vtk(std::move(field)));
  });
}
