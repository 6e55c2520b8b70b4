// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfPredict_h
#define vtkSemsurfPredict_h

#include "vtkSemsurfImageFilter.h"

/// SEM images of heights by a fast model, as `semsurf predict`.
class VTKSEMSURF_EXPORT vtkSemsurfPredict : public vtkSemsurfImageFilter {
 public:
  static vtkSemsurfPredict* New();
  vtkTypeMacro(vtkSemsurfPredict, vtkSemsurfImageFilter);

 protected:
  vtkSemsurfPredict() = default;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
};

#endif
