// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfScanReader_h
#define vtkSemsurfScanReader_h

#include <vtkImageAlgorithm.h>

#include <memory>
#include <string>

#include <vtkSemsurfModule.h>

class vtkDataArraySelection;

/// AFM scans of all formats that surf/io/height_field_file.h reads: an array for each channel,
/// heights in nm.
class VTKSEMSURF_EXPORT vtkSemsurfScanReader : public vtkImageAlgorithm {
 public:
  static vtkSemsurfScanReader* New();
  vtkTypeMacro(vtkSemsurfScanReader, vtkImageAlgorithm);

  void SetFileName(VTK_FILEPATH const char* name);
  const char* GetFileName() const { return this->FileName.c_str(); }
  int CanReadFile(VTK_FILEPATH const char* name);
  /// Length of one unit of height and pitch, of files that do not say; 0: 1 nm.
  vtkSetMacro(ZUnit, double);
  vtkSetVector2Macro(PixelSize, double);
  vtkDataArraySelection* GetChannelSelection();

  vtkMTimeType GetMTime() override;

 protected:
  vtkSemsurfScanReader();
  ~vtkSemsurfScanReader() override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  struct Contents;  // of the file
  void ReadHead();

  std::string FileName;
  double ZUnit = 0;
  double PixelSize[2] = {0, 0};
  std::unique_ptr<Contents> Scan;
};

#endif
