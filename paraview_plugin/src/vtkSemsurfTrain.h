// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfTrain_h
#define vtkSemsurfTrain_h

#include <vtkTableAlgorithm.h>

#include <string>
#include <vector>

#include <vtkSemsurfModule.h>

namespace surf {
namespace workflow {
struct TrainJob;
}
}  // namespace surf

/// A fast model of SEM images, learnt and written as `semsurf train` does it. Inputs 0 are images of heights; none:
/// surfaces of semsurf's own. Inputs 1 are images of them, one for each in the same order; none: they are simulated.
/// Output 0 says how far the model is off on each surface, output 1 what it is.
class VTKSEMSURF_EXPORT vtkSemsurfTrain : public vtkTableAlgorithm {
 public:
  static vtkSemsurfTrain* New();
  vtkTypeMacro(vtkSemsurfTrain, vtkTableAlgorithm);

  void RemoveAllImages() { this->SetInputConnection(1, nullptr); }

  vtkSetStdStringFromCharMacro(ModelFile);
  vtkSetMacro(Model, int);   ///< the kind
  vtkSetStdStringFromCharMacro(Signal);   ///< of a microscope: the array of input 1; empty: SE and BSE
  vtkSetMacro(Surfaces, int);   ///< of semsurf's own; 0: as many as the kind needs
  vtkSetMacro(SurfaceSize, int);   ///< pixels across each
  vtkSetMacro(HoldOut, int);
  vtkSetMacro(Fine, int);   ///< samples per pixel in simulations; 0: by the electrons' range
  vtkSetMacro(Edge, int);   ///< mirror, flat, periodic
  vtkSetMacro(PixelSize, double);   ///< nm; 0: that of the first input
  vtkSetStdStringFromCharMacro(Material);
  vtkSetStdStringFromCharMacro(MaterialFile);
  vtkSetMacro(Energy, double);   ///< eV
  vtkSetMacro(Spot, double);   ///< nm
  vtkSetStdStringFromCharMacro(Physics);
  vtkSetMacro(Budget, int);   ///< electrons or accuracy
  vtkSetMacro(Electrons, int);
  vtkSetMacro(Accuracy, double);
  vtkSetMacro(Seed, int);
  // Of some kinds only. Those below 0, lists without a number and 0 electrons are not given.
  void AddScale(int samples);
  void RemoveAllScales();
  void AddHidden(int units);
  void RemoveAllHidden();
  vtkSetMacro(Iterations, int);
  vtkSetMacro(Decay, double);
  vtkSetMacro(Tolerance, double);
  vtkSetMacro(CutOff, double);
  vtkSetMacro(MultiResolution, bool);
  vtkSetMacro(TableElectrons, int);

 protected:
  vtkSemsurfTrain();
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  surf::workflow::TrainJob Job(vtkInformationVector** inputs);
  void AddInputs(vtkInformationVector** inputs, surf::workflow::TrainJob& job);
  void AddModel(surf::workflow::TrainJob& job) const;

  std::string ModelFile, Signal, Material = "Si", MaterialFile, Physics;
  std::vector<int> Scales, Hidden;
  double PixelSize = 0, Energy = 1000, Spot = 0, Accuracy = 0.03, Decay = -1, Tolerance = -1, CutOff = -1;
  int Model = 0, Surfaces = 0, SurfaceSize = 64, HoldOut = 0, Fine = 0, Edge = 0, Budget = 0, Electrons = 150, Seed = 1;
  int Iterations = 0, TableElectrons = 0;
  bool MultiResolution = false;
};

#endif
