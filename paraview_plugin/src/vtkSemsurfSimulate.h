// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfSimulate_h
#define vtkSemsurfSimulate_h

#include <vtkImageAlgorithm.h>

#include <memory>
#include <string>

#include <vtkSemsurfModule.h>

/// SEM images by Monte Carlo, as `semsurf simulate`. The input is a surface, an image of heights,
/// or blocks of them. Output 0 is the image, output 1 the tracks of a few electrons, output 2 a
/// table of the detectors.
class VTKSEMSURF_EXPORT vtkSemsurfSimulate : public vtkImageAlgorithm {
 public:
  static vtkSemsurfSimulate* New();
  vtkTypeMacro(vtkSemsurfSimulate, vtkImageAlgorithm);

  enum Budgets { ByElectrons, ByAccuracy };

  /// The parameter of that name (surf/mc/request/simulation_request.h,
  /// surf/io/sim/specimen_request.h): a choice by its number.
  void SetParameter(const char* name, double value);
  void SetParameter(const char* name, const char* text);
  void SetParameter(const char* name, double a, double b, double c, double d);
  vtkSetMacro(Pixels, int);  ///< across the longer side, without a pixel size
  vtkSetMacro(Budget, int);
  vtkSetMacro(Live, bool);  ///< each update gives what there is so far

  /// Whether an update would show more, of a live simulation.
  bool GetNeedsUpdate();

 protected:
  vtkSemsurfSimulate();
  ~vtkSemsurfSimulate() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  struct State;  // what is kept between requests
  /// Makes the plan for an input anew if it or a property has changed.
  void Plan(vtkDataObject* input);

  int Pixels = 256, Budget = ByElectrons;
  bool Live = false;
  std::unique_ptr<State> Kept;
};

#endif
