// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfEstimate_h
#define vtkSemsurfEstimate_h

#include "vtkSemsurfImageFilter.h"

/// Guided images of an image with counts, as `semsurf estimate`.
class VTKSEMSURF_EXPORT vtkSemsurfEstimate : public vtkSemsurfImageFilter {
 public:
  static vtkSemsurfEstimate* New();
  vtkTypeMacro(vtkSemsurfEstimate, vtkSemsurfImageFilter);

 protected:
  vtkSemsurfEstimate() = default;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
};

#endif
