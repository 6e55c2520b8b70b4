// SPDX-License-Identifier: GPL-3.0-or-later
#include "convert/tip.h"

#include <algorithm>
#include <cmath>

#include "surf/afm/resample.h"
#include "surf/io/tip_file.h"

namespace surf::pv {

Tip to_tip(vtkImageData* image, vtkDataArray* heights, const char* subject) {
  return io::to_tip(to_height_field(image, heights, subject), texts_of(image), subject);
}

Tip to_tip_for(vtkImageData* image, vtkDataArray* heights, const HeightField& scan, const char* subject) {
  Tip tip = to_tip(image, heights, subject);
  const auto differ = [](double a, double b) { return std::abs(a - b) > 1e-6 * std::max(a, b); };
  if (!differ(tip.pitch_x_nm, scan.pitch_x_nm) && !differ(tip.pitch_y_nm, scan.pitch_y_nm)) return tip;
  return resampled(tip, scan.pitch_x_nm, scan.pitch_y_nm);
}

vtkSmartPointer<vtkImageData> to_vtk(const Tip& tip) {
  io::TipHeights heights = io::to_heights(tip);
  auto image = to_vtk(std::move(heights.field));
  add_texts(image, heights.metadata);
  return image;
}

}   // namespace surf::pv
