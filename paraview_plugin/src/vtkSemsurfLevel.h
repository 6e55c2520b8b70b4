// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfLevel_h
#define vtkSemsurfLevel_h

#include "vtkSemsurfImageFilter.h"

/// Takes the plane of the substrate, another background, or steps between scan lines off, as
/// `semsurf level` does.
class VTKSEMSURF_EXPORT vtkSemsurfLevel : public vtkSemsurfImageFilter {
 public:
  static vtkSemsurfLevel* New();
  vtkTypeMacro(vtkSemsurfLevel, vtkSemsurfImageFilter);

 protected:
  vtkSemsurfLevel() = default;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
};

#endif
