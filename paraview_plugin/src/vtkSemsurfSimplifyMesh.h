// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfSimplifyMesh_h
#define vtkSemsurfSimplifyMesh_h

#include <vtkPolyDataAlgorithm.h>

#include <memory>

#include <vtkSemsurfModule.h>

namespace surf {
namespace pv {
class PropertyValues;
}
}  // namespace surf

/// Fewer triangles within a tolerance, or down to a number (surf/mesh/simplify_mesh.h).
class VTKSEMSURF_EXPORT vtkSemsurfSimplifyMesh : public vtkPolyDataAlgorithm {
 public:
  static vtkSemsurfSimplifyMesh* New();
  vtkTypeMacro(vtkSemsurfSimplifyMesh, vtkPolyDataAlgorithm);

  enum Limits { ByTolerance, ByTriangles, ByBoth };
  vtkSetMacro(Limit, int);
  /// A described parameter of that name.
  void SetParameter(const char* name, double value);

 protected:
  vtkSemsurfSimplifyMesh();
  ~vtkSemsurfSimplifyMesh() override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs,
                          vtkInformationVector*) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  int Limit = ByTolerance;
  std::unique_ptr<surf::pv::PropertyValues> Values;  // of described parameters
};

#endif
