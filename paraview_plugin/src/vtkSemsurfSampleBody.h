// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfSampleBody_h
#define vtkSemsurfSampleBody_h

#include <vtkPolyDataAlgorithm.h>

#include <vtkSemsurfModule.h>

/// Closed bodies (surf/mesh/shapes.h). Lengths in nm.
class VTKSEMSURF_EXPORT vtkSemsurfSampleBody : public vtkPolyDataAlgorithm {
 public:
  static vtkSemsurfSampleBody* New();
  vtkTypeMacro(vtkSemsurfSampleBody, vtkPolyDataAlgorithm);

  enum Shapes { Box, Sphere, Cone };
  vtkSetMacro(Shape, int);
  vtkSetVector3Macro(Size, double);  ///< nm, of the box
  vtkSetMacro(Radius, double);       ///< nm, of the sphere, or of the cone's foot
  vtkSetMacro(TopRadius, double);    ///< nm, of the cone
  vtkSetMacro(ConeHeight, double);   ///< nm
  vtkSetMacro(Subdivisions, int);    ///< of box or sphere
  vtkSetMacro(Segments, int);        ///< of the cone
  vtkSetVector3Macro(Base, double);  ///< nm: the middle of where it stands

 protected:
  vtkSemsurfSampleBody() { this->SetNumberOfInputPorts(0); }
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  int Shape = Box;
  double Size[3] = {100, 100, 50};
  double Radius = 50;
  double TopRadius = 0;
  double ConeHeight = 100;
  int Subdivisions = 4;
  int Segments = 64;
  double Base[3] = {0, 0, 0};
};

#endif
