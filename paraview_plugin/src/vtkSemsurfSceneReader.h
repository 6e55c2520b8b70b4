// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfSceneReader_h
#define vtkSemsurfSceneReader_h

#include <vtkMultiBlockDataSetAlgorithm.h>

#include <string>

#include <vtkSemsurfModule.h>

/// Scene files (surf/io/sim/scene_file.h): a block for the height field and for each body, with
/// their materials.
class VTKSEMSURF_EXPORT vtkSemsurfSceneReader : public vtkMultiBlockDataSetAlgorithm {
 public:
  static vtkSemsurfSceneReader* New();
  vtkTypeMacro(vtkSemsurfSceneReader, vtkMultiBlockDataSetAlgorithm);

  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);

 protected:
  vtkSemsurfSceneReader() { this->SetNumberOfInputPorts(0); }
  ~vtkSemsurfSceneReader() override { this->SetFileName(nullptr); }
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  char* FileName = nullptr;
};

#endif
