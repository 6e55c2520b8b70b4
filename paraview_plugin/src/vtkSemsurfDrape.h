// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfDrape_h
#define vtkSemsurfDrape_h

#include <vtkPolyDataAlgorithm.h>

#include <vtkSemsurfModule.h>

/// Lays an image (input 1, array 0) on a surface (input 0) from straight above: as numbers and as
/// texture coordinates.
class VTKSEMSURF_EXPORT vtkSemsurfDrape : public vtkPolyDataAlgorithm {
 public:
  static vtkSemsurfDrape* New();
  vtkTypeMacro(vtkSemsurfDrape, vtkPolyDataAlgorithm);

  vtkSetVector6Macro(Transform,
                     double);  ///< from the image's frame to the surface's: xx xy x0 yx yy y0

 protected:
  vtkSemsurfDrape() { this->SetNumberOfInputPorts(2); }
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs,
                          vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  double Transform[6] = {1, 0, 0, 0, 1, 0};
};

#endif
