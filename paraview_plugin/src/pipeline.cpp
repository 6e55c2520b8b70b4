// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline.h"

#include <fmt/format.h>
#include <vtkAlgorithm.h>
#include <vtkDataArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkTable.h>

#include <algorithm>
#include <string>
#include <vector>

#include "surf/core/error.h"

namespace surf::pv {
namespace {

using Pipeline = vtkStreamingDemandDrivenPipeline;

}  // namespace

void request_whole(vtkInformationVector** inputs, int ports) {
  for (int port = 0; port < ports; ++port) {
    for (int i = 0; i < inputs[port]->GetNumberOfInformationObjects(); ++i) {
      vtkInformation* const info = inputs[port]->GetInformationObject(i);
      info->Set(Pipeline::UPDATE_PIECE_NUMBER(), 0);
      info->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), 1);
      info->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
      if (!info->Has(Pipeline::WHOLE_EXTENT())) continue;
      int extent[6];
      info->Get(Pipeline::WHOLE_EXTENT(), extent);
      info->Set(Pipeline::UPDATE_EXTENT(), extent, 6);
    }
  }
}

void announce(vtkInformation* output, const Frame& frame) {
  const int extent[6] = {0, frame.width - 1, 0, frame.height - 1, 0, 0};
  const double spacing[3] = {frame.pitch_x_nm, frame.pitch_y_nm, 1};
  const double origin[3] = {frame.origin_x_nm, frame.origin_y_nm, 0};
  output->Set(Pipeline::WHOLE_EXTENT(), extent, 6);
  output->Set(vtkDataObject::SPACING(), spacing, 3);
  output->Set(vtkDataObject::ORIGIN(), origin, 3);
  output->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
}

void give(vtkInformation* output, vtkImageData* whole) {
  vtkImageData* const image = vtkImageData::GetData(output);
  image->ShallowCopy(whole);
  if (!output->Has(Pipeline::UPDATE_EXTENT())) return;
  int asked[6], has[6];
  output->Get(Pipeline::UPDATE_EXTENT(), asked);
  whole->GetExtent(has);
  if (std::equal(asked, asked + 6, has)) return;
  for (int axis = 0; axis < 6; axis += 2) {
    if (asked[axis + 1] >= asked[axis]) continue;
    image->Initialize();  // a rank without a piece
    return;
  }
  image->Crop(asked);
}

int announce_pieces(vtkInformation* output) {
  output->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
  return 1;
}

bool is_first_piece(vtkInformation* output) {
  return !output->Has(Pipeline::UPDATE_PIECE_NUMBER()) ||
         output->Get(Pipeline::UPDATE_PIECE_NUMBER()) == 0;
}

void give(vtkInformation* output, vtkPolyData* whole) {
  if (is_first_piece(output)) vtkPolyData::GetData(output)->ShallowCopy(whole);
}

void give(vtkInformation* output, vtkTable* whole) {
  if (is_first_piece(output)) vtkTable::GetData(output)->ShallowCopy(whole);
}

vtkImageData* image_input(vtkInformationVector** inputs, int port, const char* subject, int which) {
  if (inputs[port]->GetNumberOfInformationObjects() <= which) return nullptr;
  vtkInformation* const info = inputs[port]->GetInformationObject(which);
  vtkImageData* const image = vtkImageData::GetData(info);
  if (!image || !info->Has(Pipeline::WHOLE_EXTENT())) return image;
  int whole[6], has[6];
  info->Get(Pipeline::WHOLE_EXTENT(), whole);
  image->GetExtent(has);
  if (image->GetNumberOfPoints() > 0 && !std::equal(whole, whole + 6, has))
    throw InvalidInput(subject, "only a piece of it is on this rank",
                       "Run on one rank, or put this filter before the one that spread the image");
  return image;
}

vtkPolyData* surface_input(vtkInformationVector** inputs, int port) {
  if (inputs[port]->GetNumberOfInformationObjects() == 0) return nullptr;
  return vtkPolyData::GetData(inputs[port]->GetInformationObject(0));
}

vtkDataArray* chosen_array(vtkAlgorithm* self, int index, vtkImageData* image) {
  vtkPointData* const arrays = image->GetPointData();
  vtkInformation* const wish = self->GetInputArrayInformation(index);
  const char* const given =
      wish->Has(vtkDataObject::FIELD_NAME()) ? wish->Get(vtkDataObject::FIELD_NAME()) : nullptr;
  const std::string name = given ? given : "";
  if (vtkDataArray* const array = arrays->GetArray(name.c_str())) return array;
  std::vector<vtkDataArray*> candidates;
  std::string names;
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i) {
    vtkDataArray* const array = arrays->GetArray(i);
    if (!array || !array->GetName() || array->GetNumberOfComponents() != 1) continue;
    if (std::string(array->GetName()) == mask_name) continue;
    candidates.push_back(array);
    names += std::string(names.empty() ? "'" : ", '") + array->GetName() + "'";
  }
  // A script's filter takes names from the active source at first, whatever its input is.
  if (candidates.size() == 1) return candidates.front();
  // A choice not made is empty, or the property's default, the index.
  const bool is_chosen = !name.empty() && name != std::to_string(index);
  if (is_chosen && !candidates.empty())
    throw InvalidInput("Scalars", fmt::format("the input has no array '{}' at its points", name),
                       fmt::format("Choose one of {}", names));
  if (vtkDataArray* const shown = arrays->GetScalars()) return shown;
  return candidates.empty() ? nullptr : candidates.front();
}

}  // namespace surf::pv
