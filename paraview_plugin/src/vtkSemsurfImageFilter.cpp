// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfImageFilter.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkPointData.h>

#include <utility>

#include "pipeline.h"
#include "property_values.h"

using namespace surf;

vtkSemsurfImageFilter::vtkSemsurfImageFilter() : Values(std::make_unique<pv::PropertyValues>()) {}
vtkSemsurfImageFilter::~vtkSemsurfImageFilter() = default;

void vtkSemsurfImageFilter::SetParameter(const char* name, double value) {
  if (this->Values->set(name, value)) this->Modified();
}
void vtkSemsurfImageFilter::SetParameter(const char* name, const char* text) {
  if (this->Values->set(name, text)) this->Modified();
}
void vtkSemsurfImageFilter::SetParameter(const char* name, double a, double b, double c, double d,
                                         double e, double f) {
  if (this->Values->set(name, std::vector{a, b, c, d, e, f})) this->Modified();
}

/// Samples as of the input, and pieces of them: else every rank would be asked for all.
int vtkSemsurfImageFilter::RequestInformation(vtkInformation*, vtkInformationVector**,
                                              vtkInformationVector* outputs) {
  outputs->GetInformationObject(0)->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
  return 1;
}

int vtkSemsurfImageFilter::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs,
                                               vtkInformationVector*) {
  pv::request_whole(inputs, this->GetNumberOfInputPorts());
  return 1;
}

HeightField vtkSemsurfImageFilter::Heights(vtkInformationVector** inputs, std::string& name) {
  vtkImageData* const image = pv::image_input(inputs, 0, "Input");
  vtkDataArray* const array = pv::chosen_array(this, 0, image);
  HeightField field = pv::to_height_field(image, array, "Input");
  name = array->GetName() ? array->GetName() : pv::heights_name;
  return field;
}

vtkSmartPointer<vtkImageData> vtkSemsurfImageFilter::WithHeights(vtkInformationVector** inputs,
                                                                 HeightField field,
                                                                 const std::string& name) {
  vtkImageData* const input = pv::image_input(inputs, 0, "Input");
  auto image = pv::make_image_like(input);
  image->GetPointData()->ShallowCopy(input->GetPointData());
  image->GetPointData()->RemoveArray(pv::mask_name);
  image->GetFieldData()->ShallowCopy(input->GetFieldData());
  pv::add_heights(image, std::move(field), name);
  return image;
}
