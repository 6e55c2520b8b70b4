// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfRegister_h
#define vtkSemsurfRegister_h

#include "vtkSemsurfImageFilter.h"

/// Where an SEM image (input 1) lies on a scan (input 0), as `semsurf register`; inputs 2 and 3 are
/// landmarks in the scan and in the SEM image, input 4 the tip, all three optional. Output 0 are
/// both on the scan's samples, output 1 the transform.
class VTKSEMSURF_EXPORT vtkSemsurfRegister : public vtkSemsurfImageFilter {
 public:
  static vtkSemsurfRegister* New();
  vtkTypeMacro(vtkSemsurfRegister, vtkSemsurfImageFilter);

 protected:
  vtkSemsurfRegister() {
    this->SetNumberOfInputPorts(5);
    this->SetNumberOfOutputPorts(2);
  }
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
};

#endif
