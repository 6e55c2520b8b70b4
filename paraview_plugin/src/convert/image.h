// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vtkImageData.h>
#include <vtkSmartPointer.h>

#include <map>
#include <string>

#include "surf/core/height_field.h"
#include "surf/core/image.h"
#include "surf/core/placed_image.h"

class vtkDataArray;
class vtkDataObject;

namespace surf::pv {

// VTK's images and semsurf's agree in their order: sample (0, 0) is the lower-left one, x runs
// fastest. Only names differ: a point of an image at z = 0 is a sample, and a hole is NaN.
// `subject` names the input in errors. Into semsurf values are copied once, as a Grid owns its own;
// out of it memory is handed over.

inline constexpr const char* heights_name = "z_nm";  // as in files that semsurf writes
inline constexpr const char* mask_name = "valid";    // 0 in holes; there if there are any

/// What is common to all samples of an image.
struct Frame : Placement {
  int width = 0, height = 0;

  friend bool operator==(const Frame&, const Frame&) = default;
};

/// Throws InvalidInput for an image that is no plane of x and y, is turned, or runs backwards.
Frame frame_of(vtkImageData* image, const char* subject);
inline Frame frame_of(const Grid<double>& values, const Placement& placement) {
  return {placement, values.width(), values.height()};
}

/// Without arrays, extent beginning at 0.
vtkSmartPointer<vtkImageData> make_image(const Frame& frame);
/// Without arrays, with the extent and place of another.
vtkSmartPointer<vtkImageData> make_image_like(vtkImageData* image);

/// One array of points, not finite or 0 in the array "valid": holes.
HeightField to_height_field(vtkImageData* image, vtkDataArray* heights, const char* subject);
PlacedImage to_placed_image(vtkImageData* image, vtkDataArray* values, const char* subject);

/// All arrays of points with one number each, as channels.
Image to_image(vtkImageData* image, const char* subject);

/// Adds the heights, and the mask if there are holes; they become what is shown.
void add_heights(vtkImageData* image, HeightField field, const std::string& name = heights_name);
void add_values(vtkImageData* image, Grid<double> values, const std::string& name,
                const char* unit);
void add_values(vtkImageData* image, Grid<float> values, const std::string& name, const char* unit);
void add_values(vtkImageData* image, Grid<unsigned char> values, const std::string& name,
                const char* unit);

vtkSmartPointer<vtkImageData> to_vtk(HeightField field, const std::string& name = heights_name);
vtkSmartPointer<vtkImageData> to_vtk(PlacedImage image, const std::string& name, const char* unit);
/// All channels and the metadata; the first is shown.
vtkSmartPointer<vtkImageData> to_vtk(Image image);

/// Texts that travel with data, as field data of one value each.
void add_texts(vtkDataObject* data, const std::map<std::string, std::string>& texts);
std::map<std::string, std::string> texts_of(vtkDataObject* data);

}  // namespace surf::pv
