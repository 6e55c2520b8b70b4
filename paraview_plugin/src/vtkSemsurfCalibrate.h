// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfCalibrate_h
#define vtkSemsurfCalibrate_h

#include <string>

#include "vtkSemsurfImageFilter.h"

/// Gains and offset that turn simulated channels (input 1) into a real image (input 0), as `semsurf calibrate`. Output 0
/// is the fit with its residual, output 1 the numbers.
class VTKSEMSURF_EXPORT vtkSemsurfCalibrate : public vtkSemsurfImageFilter {
 public:
  static vtkSemsurfCalibrate* New();
  vtkTypeMacro(vtkSemsurfCalibrate, vtkSemsurfImageFilter);

  vtkSetStdStringFromCharMacro(Channels);   ///< names, with commas; empty: SE and BSE, or what is shown
  vtkSetMacro(FixOffset, bool);
  vtkSetMacro(Offset, double);
  vtkSetMacro(Saturation, bool);   ///< leaves out pixels at or beyond the next two
  vtkSetMacro(Black, double);
  vtkSetMacro(White, double);

 protected:
  vtkSemsurfCalibrate() { this->SetNumberOfInputPorts(2); this->SetNumberOfOutputPorts(2); }
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  std::string Channels;
  double Offset = 0, Black = 0, White = 255;
  bool FixOffset = false, Saturation = false;
};

#endif
