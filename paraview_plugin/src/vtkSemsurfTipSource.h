// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfTipSource_h
#define vtkSemsurfTipSource_h

#include <vtkImageAlgorithm.h>

#include <vtkSemsurfModule.h>

/// Tips by their shape (surf/afm/tip_shapes.h): the structuring function about its apex at (0, 0).
class VTKSEMSURF_EXPORT vtkSemsurfTipSource : public vtkImageAlgorithm {
 public:
  static vtkSemsurfTipSource* New();
  vtkTypeMacro(vtkSemsurfTipSource, vtkImageAlgorithm);

  enum Shapes { Cone, Parabola, Pyramid, Ball };
  vtkSetMacro(Shape, int);
  vtkSetMacro(Radius, double);      ///< nm
  vtkSetMacro(HalfAngle, double);   ///< degrees from the axis
  vtkSetMacro(Faces, int);
  vtkSetMacro(Rotation, double);        ///< degrees
  vtkSetMacro(StemRadius, double);      ///< nm
  vtkSetMacro(StemHalfAngle, double);   ///< degrees
  vtkSetMacro(Samples, int);            ///< across, odd
  vtkSetMacro(Pitch, double);           ///< nm

 protected:
  vtkSemsurfTipSource() { this->SetNumberOfInputPorts(0); }
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  void Check() const;

  int Shape = Cone;
  double Radius = 10;
  double HalfAngle = 15;
  int Faces = 4;
  double Rotation = 0;
  double StemRadius = 0;
  double StemHalfAngle = 0;
  int Samples = 41;
  double Pitch = 2;
};

#endif
