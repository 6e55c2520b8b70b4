// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfRepairMesh_h
#define vtkSemsurfRepairMesh_h

#include <vtkPolyDataAlgorithm.h>

#include <vtkSemsurfModule.h>

/// What is wrong with a mesh, and a mended one. Output 0 is the mesh, output 1 a table: counts before and
/// after.
class VTKSEMSURF_EXPORT vtkSemsurfRepairMesh : public vtkPolyDataAlgorithm {
 public:
  static vtkSemsurfRepairMesh* New();
  vtkTypeMacro(vtkSemsurfRepairMesh, vtkPolyDataAlgorithm);

  vtkSetMacro(Repair, bool);
  vtkSetMacro(Stitch, double);             ///< nm; below 0: 1e-6 of the diagonal
  vtkSetMacro(Sliver, double);             ///< nm
  vtkSetMacro(MaximumHole, double);        ///< nm of rim; below 0: the component's diagonal
  vtkSetMacro(MinimumComponent, double);   ///< nm
  vtkSetMacro(ResolveIntersections, bool);

 protected:
  vtkSemsurfRepairMesh() { this->SetNumberOfOutputPorts(2); }
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector*) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  bool Repair = true;
  double Stitch = -1;
  double Sliver = 0;
  double MaximumHole = -1;
  double MinimumComponent = 0;
  bool ResolveIntersections = true;
};

#endif
