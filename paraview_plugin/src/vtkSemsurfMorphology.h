// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfMorphology_h
#define vtkSemsurfMorphology_h

#include "vtkSemsurfImageFilter.h"

/// What a tip makes of a surface, and back (surf/afm/morphology.h). Input 0 are the heights, input
/// 1 the tip.
class VTKSEMSURF_EXPORT vtkSemsurfMorphology : public vtkSemsurfImageFilter {
 public:
  static vtkSemsurfMorphology* New();
  vtkTypeMacro(vtkSemsurfMorphology, vtkSemsurfImageFilter);

  enum Operations { Erode, Dilate, Open, Close };
  vtkSetMacro(Operation, int);

 protected:
  vtkSemsurfMorphology() { this->SetNumberOfInputPorts(2); }
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  int Operation = Erode;
};

#endif
