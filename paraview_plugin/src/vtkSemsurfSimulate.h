// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfSimulate_h
#define vtkSemsurfSimulate_h

#include <vtkImageAlgorithm.h>

#include <memory>
#include <string>

#include <vtkSemsurfModule.h>

/// SEM images by Monte Carlo, as `semsurf simulate`. The input is a surface, an image of heights, or blocks of them. Output
/// 0 is the image, output 1 the tracks of a few electrons, output 2 a table of the detectors.
class VTKSEMSURF_EXPORT vtkSemsurfSimulate : public vtkImageAlgorithm {
 public:
  static vtkSemsurfSimulate* New();
  vtkTypeMacro(vtkSemsurfSimulate, vtkImageAlgorithm);

  enum Budgets { ByElectrons, ByAccuracy };
  enum Methods { Auto, Direct, Replay };

  vtkSetStdStringFromCharMacro(Materials);   ///< names, with commas; the last for all bodies that are left
  vtkSetStdStringFromCharMacro(MaterialFile);
  vtkSetStdStringFromCharMacro(Substrate);   ///< a material; empty: none
  vtkSetMacro(SubstrateTop, double);   ///< nm
  vtkSetMacro(Edge, int);   ///< of images of heights: mirror, flat, periodic
  vtkSetMacro(Energy, double);   ///< eV
  vtkSetMacro(Spot, double);   ///< nm, standard deviation
  vtkSetMacro(Tilt, double);   ///< degrees, as the next two
  vtkSetMacro(Azimuth, double);
  vtkSetMacro(Convergence, double);
  vtkSetMacro(Focus, double);   ///< nm, as the next
  vtkSetMacro(WorkingDistance, double);   ///< 0: parallel beams
  vtkSetMacro(Pixels, int);   ///< across the longer side, without a pixel size
  vtkSetMacro(PixelSize, double);   ///< nm; 0: by Pixels
  vtkSetVector4Macro(Region, double);   ///< nm, x0 y0 x1 y1; all 0: what there is of the specimen
  vtkSetMacro(Budget, int);
  vtkSetMacro(Electrons, int);   ///< per pixel
  vtkSetMacro(Accuracy, double);   ///< standard error over mean
  vtkSetMacro(AccuracyFloor, double);
  vtkSetMacro(Method, int);
  vtkSetStdStringFromCharMacro(Physics);
  vtkSetStdStringFromCharMacro(Detectors);   ///< besides SE and BSE, with semicolons
  vtkSetMacro(Seed, int);
  vtkSetMacro(Trajectories, int);   ///< primaries
  vtkSetMacro(Live, bool);   ///< each update gives what there is so far

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
  struct State;   // what is kept between requests
  void Check() const;
  /// Makes the plan for an input anew if it or a property has changed.
  void Plan(vtkDataObject* input);
  std::string Settings() const;

  std::string Materials = "Si", MaterialFile, Substrate, Physics, Detectors;
  double SubstrateTop = 0, Energy = 1000, Spot = 0, Tilt = 0, Azimuth = 0, Convergence = 0, Focus = 0, WorkingDistance = 0;
  double PixelSize = 0, Accuracy = 0.05, AccuracyFloor = 0.002;
  double Region[4] = {0, 0, 0, 0};
  int Edge = 0, Pixels = 256, Budget = ByElectrons, Electrons = 200, Method = Auto, Seed = 1, Trajectories = 0;
  bool Live = false;
  std::unique_ptr<State> Kept;
};

#endif
