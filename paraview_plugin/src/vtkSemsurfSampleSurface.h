// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfSampleSurface_h
#define vtkSemsurfSampleSurface_h

#include <vtkImageAlgorithm.h>

#include <vtkSemsurfModule.h>

namespace surf {
struct HeightField;
struct FieldExtent;
}  // namespace surf

/// Specimens as height fields (surf/mesh/shapes.h). Lengths in nm.
class VTKSEMSURF_EXPORT vtkSemsurfSampleSurface : public vtkImageAlgorithm {
 public:
  static vtkSemsurfSampleSurface* New();
  vtkTypeMacro(vtkSemsurfSampleSurface, vtkImageAlgorithm);

  enum Shapes { Mesa, Trench, Line, Via, Step, Grating, Rough, SelfAffine };
  vtkSetMacro(Shape, int);
  vtkSetMacro(Width, double);
  vtkSetMacro(Depth, double);
  vtkSetMacro(Pitch, double);
  vtkSetMacro(FeatureHeight, double);
  vtkSetMacro(FeatureWidth, double);
  vtkSetMacro(WallRun, double);
  vtkSetMacro(Period, double);
  vtkSetMacro(RmsHeight, double);
  vtkSetMacro(CorrelationLength, double);
  vtkSetMacro(HurstExponent, double);
  vtkSetMacro(Seed, int);

 protected:
  vtkSemsurfSampleSurface() { this->SetNumberOfInputPorts(0); }
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  surf::HeightField Make(const surf::FieldExtent& extent) const;

  int Shape = Mesa;
  double Width = 400;
  double Depth = 400;
  double Pitch = 2;
  double FeatureHeight = 50;
  double FeatureWidth = 150;
  double WallRun = 10;
  double Period = 200;
  double RmsHeight = 10;
  double CorrelationLength = 25;
  double HurstExponent = 0.7;
  int Seed = 1;
};

#endif
