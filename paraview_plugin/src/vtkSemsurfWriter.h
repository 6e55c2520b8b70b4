// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfWriter_h
#define vtkSemsurfWriter_h

#include <vtkWriter.h>

#include <string>

#include <vtkSemsurfModule.h>

/// What semsurf's writers share: of several ranks, which all have the whole, the first one writes.
class VTKSEMSURF_EXPORT vtkSemsurfWriter : public vtkWriter {
 public:
  vtkAbstractTypeMacro(vtkSemsurfWriter, vtkWriter);

  void SetFileName(VTK_FILEPATH const char* name);
  const char* GetFileName() const { return this->FileName.c_str(); }
  vtkTypeBool ProcessRequest(vtkInformation*, vtkInformationVector**,
                             vtkInformationVector*) override;

 protected:
  vtkSemsurfWriter() = default;
  void WriteData() override;
  /// The input under the name; throws what is wrong.
  virtual void WriteFile() = 0;

  std::string FileName;
};

#endif
