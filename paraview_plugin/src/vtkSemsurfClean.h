// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfClean_h
#define vtkSemsurfClean_h

#include "vtkSemsurfImageFilter.h"

/// Takes spikes, noise and narrow pits out of a scan, as `semsurf clean` does: in this order, what is on.
class VTKSEMSURF_EXPORT vtkSemsurfClean : public vtkSemsurfImageFilter {
 public:
  static vtkSemsurfClean* New();
  vtkTypeMacro(vtkSemsurfClean, vtkSemsurfImageFilter);

  vtkSetMacro(RemoveSpikes, bool);
  vtkSetMacro(SpikeWidth, int);      ///< samples, odd
  vtkSetMacro(SpikeLimit, double);   ///< nm; 0: six standard deviations of the pixels' noise
  vtkSetMacro(MedianFilter, bool);
  vtkSetMacro(MedianWidth, int);   ///< samples, odd
  vtkSetMacro(Disc, bool);
  vtkSetMacro(Closing, bool);
  vtkSetMacro(ClosingWidth, int);   ///< samples, odd
  vtkSetMacro(FillHoles, bool);

 protected:
  vtkSemsurfClean() = default;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  bool RemoveSpikes = true;
  int SpikeWidth = 3;
  double SpikeLimit = 0;
  bool MedianFilter = false;
  int MedianWidth = 3;
  bool Disc = false;
  bool Closing = false;
  int ClosingWidth = 3;
  bool FillHoles = false;
};

#endif
