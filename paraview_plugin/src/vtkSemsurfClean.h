// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfClean_h
#define vtkSemsurfClean_h

#include "vtkSemsurfImageFilter.h"

/// Takes spikes, noise and narrow pits out of a scan, as `semsurf clean` does: in this order, what
/// is on.
class VTKSEMSURF_EXPORT vtkSemsurfClean : public vtkSemsurfImageFilter {
 public:
  static vtkSemsurfClean* New();
  vtkTypeMacro(vtkSemsurfClean, vtkSemsurfImageFilter);

  // Whether there is such a step.
  vtkSetMacro(RemoveSpikes, bool);
  vtkSetMacro(MedianFilter, bool);
  vtkSetMacro(Closing, bool);
  vtkSetMacro(SpikeLimit, double);  ///< nm; 0: six standard deviations of the pixels' noise

 protected:
  vtkSemsurfClean() = default;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  bool RemoveSpikes = true, MedianFilter = false, Closing = false;
  double SpikeLimit = 0;
};

#endif
