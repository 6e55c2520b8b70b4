// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfSimplifyMesh_h
#define vtkSemsurfSimplifyMesh_h

#include <vtkPolyDataAlgorithm.h>

#include <vtkSemsurfModule.h>

/// Fewer triangles within a tolerance, or down to a number (surf/mesh/simplify_mesh.h).
class VTKSEMSURF_EXPORT vtkSemsurfSimplifyMesh : public vtkPolyDataAlgorithm {
 public:
  static vtkSemsurfSimplifyMesh* New();
  vtkTypeMacro(vtkSemsurfSimplifyMesh, vtkPolyDataAlgorithm);

  enum Limits { ByTolerance, ByTriangles, ByBoth };
  vtkSetMacro(Limit, int);
  vtkSetMacro(Tolerance, double);   ///< nm; 0: a thousandth of the diagonal
  vtkSetMacro(Triangles, int);

 protected:
  vtkSemsurfSimplifyMesh() = default;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector*) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  int Limit = ByTolerance;
  double Tolerance = 0;
  int Triangles = 10000;
};

#endif
