// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfToSurface_h
#define vtkSemsurfToSurface_h

#include <vtkPolyDataAlgorithm.h>

#include <vtkSemsurfModule.h>

/// Triangles over the samples of a height field, thinned or with walls and a base, as `semsurf
/// mesh` makes them.
class VTKSEMSURF_EXPORT vtkSemsurfToSurface : public vtkPolyDataAlgorithm {
 public:
  static vtkSemsurfToSurface* New();
  vtkTypeMacro(vtkSemsurfToSurface, vtkPolyDataAlgorithm);

  vtkSetMacro(Simplify, bool);
  vtkSetMacro(Tolerance, double);      ///< nm
  vtkSetMacro(MaximumTriangles, int);  ///< 0: no limit
  vtkSetMacro(Solid, bool);
  vtkSetMacro(Thickness, double);  ///< nm of the base; 0: 5 % of the longer side
  vtkSetMacro(Curvature, bool);

 protected:
  vtkSemsurfToSurface() = default;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs,
                          vtkInformationVector*) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  bool Simplify = false;
  double Tolerance = 0.1;
  int MaximumTriangles = 0;
  bool Solid = false;
  double Thickness = 0;
  bool Curvature = true;
};

#endif
