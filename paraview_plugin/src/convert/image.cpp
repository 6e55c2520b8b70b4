// SPDX-License-Identifier: GPL-3.0-or-later
#include "convert/image.h"

#include <fmt/format.h>
#include <vtkFieldData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "convert/arrays.h"
#include "surf/core/all_within.h"
#include "surf/core/error.h"

namespace surf::pv {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double most_height_nm = 1e12;

void check_plain(vtkImageData* image, const char* subject) {
  int extent[6];
  image->GetExtent(extent);
  if (extent[1] < extent[0] || extent[3] < extent[2])
    throw InvalidInput(subject, "it is empty", "Apply the filters before it first");
  if (extent[5] != extent[4])
    throw InvalidInput(
        subject, fmt::format("it has {} layers along z", extent[5] - extent[4] + 1),
        "Give an image of one layer in the plane of x and y: 'Extract Subset' takes one out");
  if (!image->GetDirectionMatrix()->IsIdentity())
    throw InvalidInput(subject, "its axes are turned", "Give an image along x and y");
}

void check_array(vtkImageData* image, vtkDataArray* array, const char* subject) {
  if (!array)
    throw InvalidInput(subject, "it has no array of one number at each of its points",
                       "'Cell Data to Point Data' makes one of cells, 'Calculator' of vectors");
  const std::string name = array->GetName() ? array->GetName() : "";
  if (array->GetNumberOfComponents() != 1)
    throw InvalidInput(
        subject,
        fmt::format("'{}' has {} numbers at each point", name, array->GetNumberOfComponents()),
        "Choose an array with one");
  if (array->GetNumberOfTuples() != image->GetNumberOfPoints())
    throw InvalidInput(subject, fmt::format("'{}' is not of the points", name),
                       "Choose an array of the points");
}

// What cannot be a scan in nm, so that nothing is computed of lengths in m or of numbers that mean
// something else.
void check_pitch(const HeightField& field, const char* subject) {
  constexpr double least_pitch_nm = 1e-6;
  const double pitch = std::min(field.pitch_x_nm, field.pitch_y_nm);
  if (pitch < least_pitch_nm)
    throw InvalidInput(subject,
                       fmt::format("its points are {:.3g} nm apart, which no scan is", pitch),
                       "Lengths are nm: multiply Spacing and heights by 1e9 if they are m");
}

void check_heights(const HeightField& field, const std::string& name, const char* subject) {
  for (const double z : field.z_nm.data())
    if (std::abs(z) > most_height_nm)
      throw InvalidInput(subject,
                         fmt::format("'{}' holds {:.3g}, which is no height in nm", name, z),
                         "Choose another array under Scalars, or make holes of such points (NaN)");
}

/// The mask of the image's points, or null.
vtkDataArray* mask_of(vtkImageData* image, vtkDataArray* values_array) {
  vtkDataArray* const mask = image->GetPointData()->GetArray(mask_name);
  const bool fits = mask && mask != values_array && mask->GetNumberOfComponents() == 1 &&
                    mask->GetNumberOfTuples() == image->GetNumberOfPoints();
  return fits ? mask : nullptr;
}

/// Takes what is not finite, or masked, out of the values; the mask is empty if there are no holes.
Mask take_holes(vtkImageData* image, vtkDataArray* values_array, Grid<double>& values) {
  Mask valid;
  vtkDataArray* const mask = mask_of(image, values_array);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool hole =
        !std::isfinite(values.data()[i]) || (mask && mask->GetComponent(vtkIdType(i), 0) == 0);
    if (!hole) continue;
    if (valid.empty()) valid = {values.width(), values.height(), 1};
    valid.data()[i] = 0;
    values.data()[i] = 0;
  }
  return valid;
}

template <class Placed>
Placed placed(const Frame& f) {
  Placed p;
  p.placement() = f.placement();
  return p;
}

Grid<double> read_values(vtkImageData* image, vtkDataArray* array, const Frame& frame,
                         const char* subject) {
  check_array(image, array, subject);
  Grid<double> values(frame.width, frame.height);
  copy_values(array, values.data());
  return values;
}

/// The mask as an array of the image, and NaN in the holes.
void add_holes(vtkImageData* image, Grid<double>& values, Mask valid) {
  if (valid.empty()) return;
  bool holes = false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (valid.data()[i]) continue;
    values.data()[i] = nan;
    holes = true;
  }
  if (holes) add_values(image, std::move(valid), mask_name, "1");
}

template <class Array, class T>
void add(vtkImageData* image, Grid<T> values, const std::string& name, const char* unit) {
  auto array = take_array<Array>(std::move(values.data()), name);
  set_unit(array, unit);
  image->GetPointData()->AddArray(array);
}

}  // namespace

Frame frame_of(vtkImageData* image, const char* subject) {
  check_plain(image, subject);
  int extent[6];
  double spacing[3], origin[3];
  image->GetExtent(extent);
  image->GetSpacing(spacing);
  image->GetOrigin(origin);
  return {{spacing[0], spacing[1], origin[0] + extent[0] * spacing[0],
           origin[1] + extent[2] * spacing[1]},
          extent[1] - extent[0] + 1,
          extent[3] - extent[2] + 1};
}

vtkSmartPointer<vtkImageData> make_image(const Frame& frame) {
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(frame.width, frame.height, 1);
  image->SetSpacing(frame.pitch_x_nm, frame.pitch_y_nm, 1);
  image->SetOrigin(frame.origin_x_nm, frame.origin_y_nm, 0);
  return image;
}

vtkSmartPointer<vtkImageData> make_image_like(vtkImageData* image) {
  auto copy = vtkSmartPointer<vtkImageData>::New();
  copy->CopyStructure(image);
  return copy;
}

HeightField to_height_field(vtkImageData* image, vtkDataArray* heights, const char* subject) {
  const Frame frame = frame_of(image, subject);
  HeightField field = placed<HeightField>(frame);
  field.z_nm = read_values(image, heights, frame, subject);
  // What is usual, heights without a hole, is looked through but once: millions of them cost a
  // millisecond each time.
  const bool usual = !mask_of(image, heights) && all_within(field.z_nm.data(), most_height_nm);
  if (!usual) field.valid = take_holes(image, heights, field.z_nm);
  validate(field, subject);
  check_pitch(field, subject);
  if (!usual) check_heights(field, heights->GetName() ? heights->GetName() : "", subject);
  return field;
}

PlacedImage to_placed_image(vtkImageData* image, vtkDataArray* values, const char* subject) {
  const Frame frame = frame_of(image, subject);
  PlacedImage result = placed<PlacedImage>(frame);
  result.values = read_values(image, values, frame, subject);
  result.valid = take_holes(image, values, result.values);
  validate(result, subject);
  return result;
}

Image to_image(vtkImageData* image, const char* subject) {
  const Frame frame = frame_of(image, subject);
  Image result = placed<Image>(frame);
  std::vector<double> values;
  for (int i = 0; i < image->GetPointData()->GetNumberOfArrays(); ++i) {
    vtkDataArray* const array = image->GetPointData()->GetArray(i);
    if (!array || !array->GetName() || array->GetNumberOfComponents() != 1) continue;
    values.resize(static_cast<std::size_t>(array->GetNumberOfTuples()));
    copy_values(array, values);
    Channel channel{array->GetName(), "1", Grid<float>(frame.width, frame.height)};
    std::ranges::transform(values, channel.values.data().begin(),
                           [](double v) { return static_cast<float>(v); });
    result.channels.push_back(std::move(channel));
  }
  validate(result, subject);
  return result;
}

void add_heights(vtkImageData* image, HeightField field, const std::string& name) {
  add_holes(image, field.z_nm, std::move(field.valid));
  add_values(image, std::move(field.z_nm), name, "nm");
  image->GetPointData()->SetActiveScalars(name.c_str());
}

void add_values(vtkImageData* image, Grid<double> values, const std::string& name,
                const char* unit) {
  add<vtkDoubleArray>(image, std::move(values), name, unit);
}

void add_values(vtkImageData* image, Grid<float> values, const std::string& name,
                const char* unit) {
  add<vtkFloatArray>(image, std::move(values), name, unit);
}

void add_values(vtkImageData* image, Grid<unsigned char> values, const std::string& name,
                const char* unit) {
  add<vtkUnsignedCharArray>(image, std::move(values), name, unit);
}

vtkSmartPointer<vtkImageData> to_vtk(HeightField field, const std::string& name) {
  auto image = make_image(frame_of(field.z_nm, field));
  add_heights(image, std::move(field), name);
  return image;
}

vtkSmartPointer<vtkImageData> to_vtk(PlacedImage placed_image, const std::string& name,
                                     const char* unit) {
  auto image = make_image(frame_of(placed_image.values, placed_image));
  add_holes(image, placed_image.values, std::move(placed_image.valid));
  add_values(image, std::move(placed_image.values), name, unit);
  image->GetPointData()->SetActiveScalars(name.c_str());
  return image;
}

vtkSmartPointer<vtkImageData> to_vtk(Image source) {
  auto image = make_image({source.placement(), source.width(), source.height()});
  for (Channel& channel : source.channels)
    add_values(image, std::move(channel.values), channel.name, channel.unit.c_str());
  if (!source.channels.empty())
    image->GetPointData()->SetActiveScalars(source.channels.front().name.c_str());
  add_texts(image, source.metadata);
  return image;
}

void add_texts(vtkDataObject* data, const std::map<std::string, std::string>& texts) {
  for (const auto& [key, value] : texts) {
    vtkNew<vtkStringArray> array;
    array->SetName(key.c_str());
    array->InsertNextValue(value);
    data->GetFieldData()->AddArray(array);
  }
}

std::map<std::string, std::string> texts_of(vtkDataObject* data) {
  std::map<std::string, std::string> texts;
  vtkFieldData* const fields = data->GetFieldData();
  for (int i = 0; i < fields->GetNumberOfArrays(); ++i) {
    auto* const array = vtkStringArray::SafeDownCast(fields->GetAbstractArray(i));
    if (array && array->GetName() && array->GetNumberOfValues() == 1)
      texts[array->GetName()] = array->GetValue(0);
  }
  return texts;
}

}  // namespace surf::pv
