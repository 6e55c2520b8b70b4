// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfNoise_h
#define vtkSemsurfNoise_h

#include <vtkTableAlgorithm.h>

#include <memory>

#include <vtkSemsurfModule.h>

namespace surf {
namespace pv {
class PropertyValues;
}
}  // namespace surf

/// The noise of a scan along its lines, as `semsurf noise` finds it: a table of quantities, and one
/// of correlations.
class VTKSEMSURF_EXPORT vtkSemsurfNoise : public vtkTableAlgorithm {
 public:
  static vtkSemsurfNoise* New();
  vtkTypeMacro(vtkSemsurfNoise, vtkTableAlgorithm);

  /// A described parameter of that name.
  void SetParameter(const char* name, double value);

 protected:
  vtkSemsurfNoise();
  ~vtkSemsurfNoise() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs,
                          vtkInformationVector*) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  std::unique_ptr<surf::pv::PropertyValues> Values;
};

#endif
