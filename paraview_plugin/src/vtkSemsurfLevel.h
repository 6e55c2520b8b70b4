// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfLevel_h
#define vtkSemsurfLevel_h

#include "vtkSemsurfImageFilter.h"

/// Takes the plane of the substrate, another background, or steps between scan lines off, as `semsurf level`
/// does.
class VTKSEMSURF_EXPORT vtkSemsurfLevel : public vtkSemsurfImageFilter {
 public:
  static vtkSemsurfLevel* New();
  vtkTypeMacro(vtkSemsurfLevel, vtkSemsurfImageFilter);

  enum Methods { Hough, LeastSquares, Polynomial, None };
  enum RowMethods { Keep, Median, Difference };
  vtkSetMacro(Method, int);
  vtkSetMacro(Tolerance, double);   ///< nm; 0: from the heights
  vtkSetMacro(Degree, int);
  vtkSetMacro(Rows, int);

 protected:
  vtkSemsurfLevel() = default;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  int Method = Hough;
  double Tolerance = 0;
  int Degree = 2;
  int Rows = Keep;
};

#endif
