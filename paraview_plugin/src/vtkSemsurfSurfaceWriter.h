// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfSurfaceWriter_h
#define vtkSemsurfSurfaceWriter_h

#include "vtkSemsurfWriter.h"

/// Surfaces with their scalars as surf/io/surface_file.h writes them, by extension.
class VTKSEMSURF_EXPORT vtkSemsurfSurfaceWriter : public vtkSemsurfWriter {
 public:
  static vtkSemsurfSurfaceWriter* New();
  vtkTypeMacro(vtkSemsurfSurfaceWriter, vtkSemsurfWriter);

  vtkSetMacro(Magnification, double);
  vtkSetMacro(ZExaggeration, double);

 protected:
  vtkSemsurfSurfaceWriter() = default;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteFile() override;

 private:
  double Magnification = 1e6;
  double ZExaggeration = 1;
};

#endif
