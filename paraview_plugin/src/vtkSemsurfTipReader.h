// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfTipReader_h
#define vtkSemsurfTipReader_h

#include "vtkSemsurfImageReader.h"

/// Tips as surf/io/tip_file.h reads them: the structuring function about its apex at (0, 0).
class VTKSEMSURF_EXPORT vtkSemsurfTipReader : public vtkSemsurfImageReader {
 public:
  static vtkSemsurfTipReader* New();
  vtkTypeMacro(vtkSemsurfTipReader, vtkSemsurfImageReader);

 protected:
  vtkSemsurfTipReader() = default;
  vtkSmartPointer<vtkImageData> Read() override;
};

#endif
