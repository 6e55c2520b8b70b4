// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfMeshReader_h
#define vtkSemsurfMeshReader_h

#include <vtkPolyDataAlgorithm.h>

#include <string>

#include <vtkSemsurfModule.h>

/// Meshes in nm, of all formats that surf/io/surface_file.h reads: the bodies of a file as one data
/// set, told apart by the cells' array "surface".
class VTKSEMSURF_EXPORT vtkSemsurfMeshReader : public vtkPolyDataAlgorithm {
 public:
  static vtkSemsurfMeshReader* New();
  vtkTypeMacro(vtkSemsurfMeshReader, vtkPolyDataAlgorithm);

  void SetFileName(VTK_FILEPATH const char* name);
  const char* GetFileName() const { return this->FileName.c_str(); }
  vtkSetMacro(Unit, double);       ///< nm; 0: what the file or its format says
  vtkSetMacro(OverrideUnit, int);  ///< not 0: Unit counts even where the file says another one

 protected:
  vtkSemsurfMeshReader() { this->SetNumberOfInputPorts(0); }
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  std::string FileName;
  double Unit = 0;
  int OverrideUnit = 0;
};

#endif
