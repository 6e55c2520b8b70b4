// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfMeshReader.h"

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkObjectFactory.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "attempt.h"
#include "checks.h"
#include "convert/arrays.h"
#include "convert/mesh.h"
#include "pipeline.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/surface_file.h"

vtkStandardNewMacro(vtkSemsurfMeshReader);

using namespace surf;

namespace {

/// Appends; keeps the scalars that both have. Returns the triangles that came.
void append(Surface& all, Surface more) {
  const auto first = static_cast<std::uint32_t>(all.mesh.vertices_nm.size());
  all.mesh.vertices_nm.insert(all.mesh.vertices_nm.end(), more.mesh.vertices_nm.begin(),
                              more.mesh.vertices_nm.end());
  for (Triangle t : more.mesh.triangles)
    all.mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  std::erase_if(all.scalars, [&](VertexScalar& scalar) {
    const auto same = std::ranges::find(more.scalars, scalar.name, &VertexScalar::name);
    if (same == more.scalars.end()) return true;
    scalar.values.insert(scalar.values.end(), same->values.begin(), same->values.end());
    return false;
  });
}

}  // namespace

void vtkSemsurfMeshReader::SetFileName(const char* name) {
  const std::string value = name ? name : "";
  if (value == this->FileName) return;
  this->FileName = value;
  this->Modified();
}

int vtkSemsurfMeshReader::RequestInformation(vtkInformation*, vtkInformationVector**,
                                             vtkInformationVector* outputs) {
  return pv::announce_pieces(outputs->GetInformationObject(0));
}

int vtkSemsurfMeshReader::RequestData(vtkInformation*, vtkInformationVector**,
                                      vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    vtkInformation* const output = outputs->GetInformationObject(0);
    if (!pv::is_first_piece(output)) return;
    if (this->FileName.empty()) throw UsageError("FileName", "no file is named", "Name one");
    pv::need_length(this->Unit, "Unit");
    if (this->OverrideUnit && !(this->Unit > 0))
      throw UsageError("Override Unit", "there is no unit to take in place of the file's",
                       "Give Unit, or leave it out");
    Surface all;
    std::vector<int> numbers;
    std::map<std::string, std::string> texts;
    pv::work(this, [&](const Watch& watch) {
      SurfaceScene scene = io::read_surfaces(
          this->FileName,
          {this->Unit > 0 ? std::optional(this->Unit) : std::nullopt, this->OverrideUnit != 0});
      watch.report(0.8, 1);
      texts = scene.metadata;
      if (this->OverrideUnit) texts["unit_override"] = format_exact(this->Unit) + " nm";
      for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
        numbers.insert(numbers.end(), scene.surfaces[i].mesh.triangles.size(), static_cast<int>(i));
        texts[fmt::format("surface:{}", i)] = scene.surfaces[i].name;
        if (i == 0) all = std::move(scene.surfaces[i]);
        else append(all, std::move(scene.surfaces[i]));
      }
    });
    const auto data = pv::to_vtk(std::move(all));
    data->GetCellData()->AddArray(pv::take_array<vtkIntArray>(std::move(numbers), "surface"));
    pv::add_texts(data, texts);
    pv::give(output, data);
  });
}
