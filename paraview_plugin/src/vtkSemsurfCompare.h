// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfCompare_h
#define vtkSemsurfCompare_h

#include "vtkSemsurfImageFilter.h"

/// Where heights after (input 1) differ from heights before (input 0) beyond their errors, as
/// `semsurf compare`. Output 0 are maps, output 1 the places that changed.
class VTKSEMSURF_EXPORT vtkSemsurfCompare : public vtkSemsurfImageFilter {
 public:
  static vtkSemsurfCompare* New();
  vtkTypeMacro(vtkSemsurfCompare, vtkSemsurfImageFilter);

 protected:
  vtkSemsurfCompare() {
    this->SetNumberOfInputPorts(2);
    this->SetNumberOfOutputPorts(2);
  }
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
};

#endif
