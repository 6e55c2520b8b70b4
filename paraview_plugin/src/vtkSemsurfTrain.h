// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfTrain_h
#define vtkSemsurfTrain_h

#include <vtkTableAlgorithm.h>

#include <memory>
#include <string>

#include <vtkSemsurfModule.h>

namespace surf {
namespace pv {
class PropertyValues;
}
namespace workflow {
struct TrainJob;
}
}  // namespace surf

/// A fast model of SEM images, learnt and written as `semsurf train` does it. Inputs 0 are images
/// of heights; none: surfaces of semsurf's own. Inputs 1 are images of them, one for each in the
/// same order; none: they are simulated. Output 0 says how far the model is off on each surface,
/// output 1 what it is.
class VTKSEMSURF_EXPORT vtkSemsurfTrain : public vtkTableAlgorithm {
 public:
  static vtkSemsurfTrain* New();
  vtkTypeMacro(vtkSemsurfTrain, vtkTableAlgorithm);

  void RemoveAllImages() { this->SetInputConnection(1, nullptr); }

  vtkSetStdStringFromCharMacro(
      Signal);               ///< of a microscope: the array of input 1; empty: SE and BSE
  vtkSetMacro(Budget, int);  ///< electrons or accuracy
  /// A described parameter of that name: a choice by its number.
  void SetParameter(const char* name, double value);
  void SetParameter(const char* name, const char* text);

 protected:
  vtkSemsurfTrain();
  ~vtkSemsurfTrain() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**,
                         vtkInformationVector* outputs) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs,
                          vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  surf::workflow::TrainJob Job(vtkInformationVector** inputs);
  void AddInputs(vtkInformationVector** inputs, surf::workflow::TrainJob& job);

  std::string Signal;
  int Budget = 0;
  std::unique_ptr<surf::pv::PropertyValues> Values;  // of described parameters
};

#endif
