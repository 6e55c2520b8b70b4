// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfCalibrate_h
#define vtkSemsurfCalibrate_h

#include "vtkSemsurfImageFilter.h"

/// Gains and offset that turn simulated channels (input 1) into a real image (input 0), as `semsurf
/// calibrate`. Output 0 is the fit with its residual, output 1 the numbers.
class VTKSEMSURF_EXPORT vtkSemsurfCalibrate : public vtkSemsurfImageFilter {
 public:
  static vtkSemsurfCalibrate* New();
  vtkTypeMacro(vtkSemsurfCalibrate, vtkSemsurfImageFilter);

 protected:
  vtkSemsurfCalibrate() {
    this->SetNumberOfInputPorts(2);
    this->SetNumberOfOutputPorts(2);
  }
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
};

#endif
