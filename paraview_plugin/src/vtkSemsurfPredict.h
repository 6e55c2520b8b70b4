// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfPredict_h
#define vtkSemsurfPredict_h

#include <string>

#include "vtkSemsurfImageFilter.h"

/// SEM images of heights by a fast model, as `semsurf predict`.
class VTKSEMSURF_EXPORT vtkSemsurfPredict : public vtkSemsurfImageFilter {
 public:
  static vtkSemsurfPredict* New();
  vtkTypeMacro(vtkSemsurfPredict, vtkSemsurfImageFilter);

  vtkSetStdStringFromCharMacro(ModelFile);
  vtkSetMacro(Resample, bool);   ///< heights of another pitch, to the model's pixels
  vtkSetMacro(Edge, int);   ///< mirror, flat, periodic

 protected:
  vtkSemsurfPredict() = default;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  surf::HeightField AtPixel(const surf::HeightField& field, double pixel_nm) const;

  std::string ModelFile;
  bool Resample = true;
  int Edge = 0;
};

#endif
