// SPDX-License-Identifier: GPL-3.0-or-later
#include "convert/tip.h"

#include "reports.h"
#include "surf/core/error.h"
#include "surf/io/tip_file.h"
#include "surf/workflow/morphology_job.h"

namespace surf::pv {

Tip to_tip(vtkImageData* image, vtkDataArray* heights, const char* subject) {
  return io::to_tip(to_height_field(image, heights, subject), texts_of(image), subject);
}

Tip to_tip_for(vtkImageData* image, vtkDataArray* heights, const HeightField& scan,
               const char* subject, std::vector<std::string>& warnings) {
  if (!image)
    throw UsageError(subject, "it is missing",
                     "Choose the result Tip of Estimate Tip, an AFM Tip, or a tip that is read");
  return workflow::tip_for(to_tip(image, heights, subject), scan, subject, hear({}, warnings));
}

vtkSmartPointer<vtkImageData> to_vtk(const Tip& tip) {
  io::TipHeights heights = io::to_heights(tip);
  auto image = to_vtk(std::move(heights.field));
  add_texts(image, heights.metadata);
  return image;
}

}  // namespace surf::pv
