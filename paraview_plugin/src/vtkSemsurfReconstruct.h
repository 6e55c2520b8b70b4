// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfReconstruct_h
#define vtkSemsurfReconstruct_h

#include <string>

#include "vtkSemsurfImageFilter.h"

/// The surface that makes a scan (input 0) and an SEM image (input 1, optional) most likely, as `semsurf reconstruct`; input
/// 2 is the tip, inputs 3 and 4 are landmarks, all optional. Outputs: the surface as an image and as triangles, the
/// residuals of scan and SEM image, the history.
class VTKSEMSURF_EXPORT vtkSemsurfReconstruct : public vtkSemsurfImageFilter {
 public:
  static vtkSemsurfReconstruct* New();
  vtkTypeMacro(vtkSemsurfReconstruct, vtkSemsurfImageFilter);

  vtkSetStdStringFromCharMacro(ModelFile);
  vtkSetStdStringFromCharMacro(Material);   ///< without a model
  vtkSetMacro(Energy, double);   ///< eV
  vtkSetMacro(Spot, double);   ///< nm
  vtkSetMacro(Level, int);   ///< as `semsurf reconstruct --level-method`
  vtkSetMacro(UseTransform, bool);   ///< instead of searching for it
  vtkSetVector6Macro(Transform, double);
  vtkSetMacro(AcceptRegistration, bool);   ///< one that is not verified
  vtkSetMacro(Method, int);
  vtkSetMacro(Iterations, int);   ///< of each scale; 0: the method's own
  vtkSetMacro(Upsample, int);
  vtkSetMacro(Uncertainty, bool);

 protected:
  vtkSemsurfReconstruct() { this->SetNumberOfInputPorts(5); this->SetNumberOfOutputPorts(5); }
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  std::string ModelFile, Material = "Si";
  double Energy = 1000, Spot = 0, Transform[6] = {1, 0, 0, 0, 1, 0};
  int Level = 0, Method = 0, Iterations = 0, Upsample = 3;
  bool UseTransform = false, AcceptRegistration = false, Uncertainty = true;
};

#endif
