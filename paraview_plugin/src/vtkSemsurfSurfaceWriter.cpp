// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfSurfaceWriter.h"

#include <vtkInformation.h>
#include <vtkObjectFactory.h>

#include <utility>

#include "checks.h"
#include "convert/image.h"
#include "convert/mesh.h"
#include "surf/io/surface_file.h"

vtkStandardNewMacro(vtkSemsurfSurfaceWriter);

using namespace surf;

int vtkSemsurfSurfaceWriter::FillInputPortInformation(int, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  return 1;
}

void vtkSemsurfSurfaceWriter::WriteFile() {
  for (const auto& [value, label] :
       {std::pair{this->Magnification, "Magnification"}, {this->ZExaggeration, "Z Exaggeration"}})
    pv::need_between(value, 1e-12, 1e12, label);
  auto* const data = vtkPolyData::SafeDownCast(this->GetInput());
  SurfaceScene scene;
  scene.surfaces.push_back(pv::to_surface(data, "Input"));
  scene.surfaces.front().name = std::filesystem::path(this->FileName).stem().string();
  scene.metadata = pv::texts_of(data);
  io::write_surfaces(this->FileName, scene, {this->Magnification, this->ZExaggeration});
}
