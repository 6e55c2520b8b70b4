// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfEstimateTip_h
#define vtkSemsurfEstimateTip_h

#include "vtkSemsurfImageFilter.h"

namespace surf {
namespace workflow {
struct TipParameters;
}
}   // namespace surf

/// The tip that made a scan, as `semsurf tip` finds it. Output 0 is the tip, output 1 a table: the curve of
/// thresholds of a sweep, the candidates of the best tip, else how the tip was found.
class VTKSEMSURF_EXPORT vtkSemsurfEstimateTip : public vtkSemsurfImageFilter {
 public:
  static vtkSemsurfEstimateTip* New();
  vtkTypeMacro(vtkSemsurfEstimateTip, vtkSemsurfImageFilter);

  enum Answers { Sweep, OuterBound, Best, Blind };
  vtkSetMacro(Answer, int);
  vtkSetMacro(TipSize, int);               ///< samples across, odd
  vtkSetMacro(Threshold, double);          ///< nm, of Blind
  vtkSetMacro(ApexTolerance, double);      ///< nm, of Blind
  vtkSetMacro(Noise, double);              ///< nm, standard deviation; 0: from the scan
  vtkSetMacro(NoiseCorrelation, double);   ///< of neighbours along rows, in (-1, 1), where Noise is given
  vtkSetMacro(Thresholds, int);            ///< of the sweep
  vtkSetVector2Macro(ThresholdRange, double);   ///< nm; both 0: from the noise
  vtkSetMacro(Seed, int);

 protected:
  vtkSemsurfEstimateTip() { this->SetNumberOfOutputPorts(2); }
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  void Check() const;
  surf::workflow::TipParameters Parameters() const;

  int Answer = Sweep;
  int TipSize = 21;
  double Threshold = 0.5;
  double ApexTolerance = 0.5;
  double Noise = 0;
  double NoiseCorrelation = 0;
  int Thresholds = 40;
  double ThresholdRange[2] = {0, 0};
  int Seed = 1;
};

#endif
