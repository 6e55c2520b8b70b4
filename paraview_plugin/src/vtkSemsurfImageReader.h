// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfImageReader_h
#define vtkSemsurfImageReader_h

#include <vtkImageAlgorithm.h>
#include <vtkSmartPointer.h>

#include <memory>
#include <string>

#include <vtkSemsurfModule.h>

/// Images that one file gives whole: SEM images and tips. Read once, as long as the file and the
/// properties stay.
class VTKSEMSURF_EXPORT vtkSemsurfImageReader : public vtkImageAlgorithm {
 public:
  vtkAbstractTypeMacro(vtkSemsurfImageReader, vtkImageAlgorithm);

  void SetFileName(VTK_FILEPATH const char* name);
  const char* GetFileName() const { return this->FileName.c_str(); }

 protected:
  vtkSemsurfImageReader();
  ~vtkSemsurfImageReader() override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  /// All of the file, as an image from extent 0 on.
  virtual vtkSmartPointer<vtkImageData> Read() = 0;

  std::string FileName;

 private:
  void ReadOnce();

  struct Contents;
  std::unique_ptr<Contents> File;
};

#endif
