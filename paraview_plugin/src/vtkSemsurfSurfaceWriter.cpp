// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfSurfaceWriter.h"

#include <vtkInformation.h>
#include <vtkObjectFactory.h>

#include "convert/image.h"
#include "convert/mesh.h"
#include "surf/core/error.h"
#include "surf/io/surface_file.h"

vtkStandardNewMacro(vtkSemsurfSurfaceWriter);

using namespace surf;

int vtkSemsurfSurfaceWriter::FillInputPortInformation(int, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  return 1;
}

void vtkSemsurfSurfaceWriter::WriteFile() {
  if (!(this->Magnification > 0) || !(this->ZExaggeration > 0))
    throw UsageError(this->Magnification > 0 ? "Z Exaggeration" : "Magnification", "it is not above 0",
                     "Give 1");
  auto* const data = vtkPolyData::SafeDownCast(this->GetInput());
  SurfaceScene scene;
  scene.surfaces.push_back(pv::to_surface(data, "Input"));
  scene.surfaces.front().name = std::filesystem::path(this->FileName).stem().string();
  scene.metadata = pv::texts_of(data);
  io::write_surfaces(this->FileName, scene, {this->Magnification, this->ZExaggeration});
}
