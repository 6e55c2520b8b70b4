// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfCertainty_h
#define vtkSemsurfCertainty_h

#include "vtkSemsurfImageFilter.h"

/// Where the eroded scan is the surface, as `semsurf certainty` says. Input 0 is the scan, input 1
/// the tip.
class VTKSEMSURF_EXPORT vtkSemsurfCertainty : public vtkSemsurfImageFilter {
 public:
  static vtkSemsurfCertainty* New();
  vtkTypeMacro(vtkSemsurfCertainty, vtkSemsurfImageFilter);

 protected:
  vtkSemsurfCertainty() { this->SetNumberOfInputPorts(2); }
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
};

#endif
