// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfLineProfile_h
#define vtkSemsurfLineProfile_h

#include <vtkTableAlgorithm.h>

#include <vtkSemsurfModule.h>

/// What a scan (input 0), an SEM image (input 1) and a surface (input 2) show along one line of the
/// scan's frame.
class VTKSEMSURF_EXPORT vtkSemsurfLineProfile : public vtkTableAlgorithm {
 public:
  static vtkSemsurfLineProfile* New();
  vtkTypeMacro(vtkSemsurfLineProfile, vtkTableAlgorithm);

  vtkSetVector3Macro(
      Point1,
      double);  ///< nm; z plays no part. Where both are the same: across the middle of the scan
  vtkSetVector3Macro(Point2, double);
  vtkSetMacro(Samples, int);
  vtkSetVector6Macro(Transform, double);  ///< from the SEM's frame to the scan's

 protected:
  vtkSemsurfLineProfile() { this->SetNumberOfInputPorts(3); }
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs,
                          vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  double Point1[3] = {0, 0, 0}, Point2[3] = {0, 0, 0};
  double Transform[6] = {1, 0, 0, 0, 1, 0};
  int Samples = 500;
};

#endif
