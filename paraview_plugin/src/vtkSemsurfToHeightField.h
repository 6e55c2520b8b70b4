// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfToHeightField_h
#define vtkSemsurfToHeightField_h

#include <vtkImageAlgorithm.h>

#include <vtkSemsurfModule.h>

/// A surface seen from above, on a grid (surf/mesh/mesh_height_field.h).
class VTKSEMSURF_EXPORT vtkSemsurfToHeightField : public vtkImageAlgorithm {
 public:
  static vtkSemsurfToHeightField* New();
  vtkTypeMacro(vtkSemsurfToHeightField, vtkImageAlgorithm);

  vtkSetMacro(Samples, int);   ///< along the longer side
  vtkSetMacro(Pitch, double);  ///< nm; 0: from Samples

 protected:
  vtkSemsurfToHeightField() = default;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs,
                          vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  double PitchFor(double width_nm, double depth_nm) const;

  int Samples = 256;
  double Pitch = 0;
};

#endif
