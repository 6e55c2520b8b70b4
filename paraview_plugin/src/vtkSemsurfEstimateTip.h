// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfEstimateTip_h
#define vtkSemsurfEstimateTip_h

#include "vtkSemsurfImageFilter.h"

namespace surf {
namespace workflow {
struct TipParameters;
}
}  // namespace surf

/// The tip that made a scan, as `semsurf tip` finds it. Output 0 is the tip, output 1 a table: the
/// curve of thresholds of a sweep, the candidates of the best tip, else how the tip was found.
class VTKSEMSURF_EXPORT vtkSemsurfEstimateTip : public vtkSemsurfImageFilter {
 public:
  static vtkSemsurfEstimateTip* New();
  vtkTypeMacro(vtkSemsurfEstimateTip, vtkSemsurfImageFilter);

 protected:
  vtkSemsurfEstimateTip() { this->SetNumberOfOutputPorts(2); }
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  /// Throws UsageError for what cannot be.
  surf::workflow::TipParameters Parameters() const;
};

#endif
