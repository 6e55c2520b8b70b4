// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfHeightFieldWriter.h"

#include <vtkInformation.h>
#include <vtkObjectFactory.h>

#include "pipeline.h"
#include "surf/io/height_field_file.h"

vtkStandardNewMacro(vtkSemsurfHeightFieldWriter);

using namespace surf;

int vtkSemsurfHeightFieldWriter::FillInputPortInformation(int, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

void vtkSemsurfHeightFieldWriter::WriteFile() {
  auto* const image = vtkImageData::SafeDownCast(this->GetInput());
  io::write_height_field(this->FileName,
                         pv::to_height_field(image, pv::chosen_array(this, 0, image), "Input"),
                         pv::texts_of(image));
}
