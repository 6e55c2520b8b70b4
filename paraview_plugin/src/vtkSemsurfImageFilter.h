// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfImageFilter_h
#define vtkSemsurfImageFilter_h

#include <vtkImageAlgorithm.h>
#include <vtkSmartPointer.h>

#include <memory>
#include <string>

#include <vtkSemsurfModule.h>

namespace surf {
struct HeightField;
namespace pv {
class PropertyValues;
}
}  // namespace surf

/// What filters from one height field to images of the same samples share: they ask for all of
/// every input. Input array 0 are the heights; outputs keep the input's other arrays.
class VTKSEMSURF_EXPORT vtkSemsurfImageFilter : public vtkImageAlgorithm {
 public:
  vtkAbstractTypeMacro(vtkSemsurfImageFilter, vtkImageAlgorithm);

  /// A described parameter of that name: a choice by its number.
  void SetParameter(const char* name, double value);
  void SetParameter(const char* name, const char* text);
  void SetParameter(const char* name, double a, double b, double c, double d, double e, double f);

 protected:
  vtkSemsurfImageFilter();
  ~vtkSemsurfImageFilter() override;
  int RequestInformation(vtkInformation*, vtkInformationVector**,
                         vtkInformationVector* outputs) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs,
                          vtkInformationVector*) override;

  /// The chosen heights of input 0, and how they are called.
  surf::HeightField Heights(vtkInformationVector** inputs, std::string& name);
  /// Input 0 with other heights of that name, and without the mask of the old ones.
  vtkSmartPointer<vtkImageData> WithHeights(vtkInformationVector** inputs, surf::HeightField field,
                                            const std::string& name);

  std::unique_ptr<surf::pv::PropertyValues> Values;  // of described parameters
};

#endif
