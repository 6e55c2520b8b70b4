// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef vtkSemsurfHeightFieldWriter_h
#define vtkSemsurfHeightFieldWriter_h

#include "vtkSemsurfWriter.h"

/// Heights as surf/io/height_field_file.h writes them, by extension.
class VTKSEMSURF_EXPORT vtkSemsurfHeightFieldWriter : public vtkSemsurfWriter {
 public:
  static vtkSemsurfHeightFieldWriter* New();
  vtkTypeMacro(vtkSemsurfHeightFieldWriter, vtkSemsurfWriter);

 protected:
  vtkSemsurfHeightFieldWriter() = default;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteFile() override;
};

#endif
