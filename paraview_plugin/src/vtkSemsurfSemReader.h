// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfSemReader_h
#define vtkSemsurfSemReader_h

#include "vtkSemsurfImageReader.h"

/// SEM images with the pixel size that their microscope noted (surf/io/sem_file.h).
class VTKSEMSURF_EXPORT vtkSemsurfSemReader : public vtkSemsurfImageReader {
 public:
  static vtkSemsurfSemReader* New();
  vtkTypeMacro(vtkSemsurfSemReader, vtkSemsurfImageReader);

  void SetChannel(const char* name);
  vtkSetVector2Macro(PixelSize, double);  ///< nm; 0: what the file says
  vtkSetMacro(KeepDatabar, bool);

 protected:
  vtkSemsurfSemReader() = default;
  vtkSmartPointer<vtkImageData> Read() override;

 private:
  std::string Channel;
  double PixelSize[2] = {0, 0};
  bool KeepDatabar = false;
};

#endif
