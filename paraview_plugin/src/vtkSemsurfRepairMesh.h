// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfRepairMesh_h
#define vtkSemsurfRepairMesh_h

#include <vtkPolyDataAlgorithm.h>

#include <memory>

#include <vtkSemsurfModule.h>

namespace surf {
namespace pv {
class PropertyValues;
}
}  // namespace surf

/// What is wrong with a mesh, and a mended one. Output 0 is the mesh, output 1 a table: counts
/// before and after.
class VTKSEMSURF_EXPORT vtkSemsurfRepairMesh : public vtkPolyDataAlgorithm {
 public:
  static vtkSemsurfRepairMesh* New();
  vtkTypeMacro(vtkSemsurfRepairMesh, vtkPolyDataAlgorithm);

  vtkSetMacro(Repair, bool);
  /// A described parameter of that name.
  void SetParameter(const char* name, double value);

 protected:
  vtkSemsurfRepairMesh();
  ~vtkSemsurfRepairMesh() override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs,
                          vtkInformationVector*) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  bool Repair = true;
  std::unique_ptr<surf::pv::PropertyValues> Values;  // of described parameters
};

#endif
