// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfNoise_h
#define vtkSemsurfNoise_h

#include <vtkTableAlgorithm.h>

#include <vtkSemsurfModule.h>

/// The noise of a scan along its lines, as `semsurf noise` finds it: a table of quantities, and one of
/// correlations.
class VTKSEMSURF_EXPORT vtkSemsurfNoise : public vtkTableAlgorithm {
 public:
  static vtkSemsurfNoise* New();
  vtkTypeMacro(vtkSemsurfNoise, vtkTableAlgorithm);

  vtkSetMacro(Flat, bool);    ///< all of the scan is flat
  vtkSetMacro(Degree, int);   ///< of the polynomial taken off
  vtkSetMacro(Lags, int);

 protected:
  vtkSemsurfNoise() {
    this->SetNumberOfInputPorts(1);
    this->SetNumberOfOutputPorts(2);
  }
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector*) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  bool Flat = false;
  int Degree = 2;
  int Lags = 10;
};

#endif
