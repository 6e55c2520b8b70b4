// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfProfile_h
#define vtkSemsurfProfile_h

#include "vtkSemsurfImageFilter.h"

/// Widths, walls and edges of lines, trenches, edges or a hole in an SEM image (input 0), as
/// `semsurf profile`; further images at input 0 see such features from other sides; input 1 is a
/// scan that shows how high walls are, optional. Outputs: the surface as an image and as triangles,
/// the edges as lines, what the fit leaves of the image, and tables of the numbers, of the edges by
/// rows, of mean profiles and of the roughness.
class VTKSEMSURF_EXPORT vtkSemsurfProfile : public vtkSemsurfImageFilter {
 public:
  static vtkSemsurfProfile* New();
  vtkTypeMacro(vtkSemsurfProfile, vtkSemsurfImageFilter);

 protected:
  vtkSemsurfProfile() {
    this->SetNumberOfInputPorts(2);
    this->SetNumberOfOutputPorts(8);
  }
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**,
                         vtkInformationVector* outputs) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
};

#endif
