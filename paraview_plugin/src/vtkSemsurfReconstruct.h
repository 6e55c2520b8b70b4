// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfReconstruct_h
#define vtkSemsurfReconstruct_h

#include "vtkSemsurfImageFilter.h"

/// The surface that makes a scan (input 0) and an SEM image (input 1, optional) most likely, as
/// `semsurf reconstruct`; further images at input 1 see it from other sides; input 2 is the tip,
/// inputs 3 and 4 are landmarks, all optional. Outputs: the surface as an image and as triangles,
/// the residuals of scan and SEM image, the history, and further SEM images as blocks.
class VTKSEMSURF_EXPORT vtkSemsurfReconstruct : public vtkSemsurfImageFilter {
 public:
  static vtkSemsurfReconstruct* New();
  vtkTypeMacro(vtkSemsurfReconstruct, vtkSemsurfImageFilter);

  void RemoveAllSems() { this->SetInputConnection(1, nullptr); }

  vtkSetMacro(UseTransform, bool);  ///< instead of searching for it

 protected:
  vtkSemsurfReconstruct() {
    this->SetNumberOfInputPorts(5);
    this->SetNumberOfOutputPorts(6);
  }
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  bool UseTransform = false;
};

#endif
