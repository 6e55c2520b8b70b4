// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfTipSource_h
#define vtkSemsurfTipSource_h

#include <vtkImageAlgorithm.h>

#include <memory>

#include <vtkSemsurfModule.h>

namespace surf {
namespace pv {
class PropertyValues;
}
namespace workflow {
struct TipShapeParameters;
}
}  // namespace surf

/// Tips by their shape (surf/afm/tip_shapes.h): the structuring function about its apex at (0, 0).
class VTKSEMSURF_EXPORT vtkSemsurfTipSource : public vtkImageAlgorithm {
 public:
  static vtkSemsurfTipSource* New();
  vtkTypeMacro(vtkSemsurfTipSource, vtkImageAlgorithm);

  /// A described parameter of that name: a choice by its number.
  void SetParameter(const char* name, double value);
  vtkSetMacro(Pitch, double);  ///< nm

 protected:
  vtkSemsurfTipSource();
  ~vtkSemsurfTipSource() override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  surf::workflow::TipShapeParameters Parameters() const;

  std::unique_ptr<surf::pv::PropertyValues> Values;  // of described parameters
  double Pitch = 2;
};

#endif
