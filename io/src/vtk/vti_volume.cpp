// SPDX-License-Identifier: GPL-3.0-or-later
// A volume as VTK's image file, its cells' values.
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkXMLImageDataWriter.h>

#include "surf/core/error.h"
#include "vtk_functions.h"
#include "vtk_support.h"

namespace surf::io::vtk {

void write_volume(const std::filesystem::path& target, const std::string& file,
                  const Volume& volume) {
  vtkNew<vtkImageData> data;
  data->SetDimensions(volume.cells[0] + 1, volume.cells[1] + 1, volume.cells[2] + 1);
  data->SetOrigin(volume.lower_nm.x, volume.lower_nm.y, volume.lower_nm.z);
  data->SetSpacing(volume.cell_nm.x, volume.cell_nm.y, volume.cell_nm.z);
  vtkNew<vtkFloatArray> array;
  array->SetName(volume.name.c_str());
  array->SetNumberOfTuples(static_cast<vtkIdType>(volume.values.size()));
  for (std::size_t i = 0; i < volume.values.size(); ++i)
    array->SetValue(static_cast<vtkIdType>(i), static_cast<float>(volume.values[i]));
  data->GetCellData()->SetScalars(array);
  add_text(data->GetFieldData(), "unit." + volume.name, volume.unit);
  for (const auto& [key, value] : volume.metadata) add_text(data->GetFieldData(), key, value);
  vtkNew<vtkXMLImageDataWriter> writer;
  writer->SetFileName(target.c_str());
  writer->SetInputData(data);
  writer->SetDataModeToBinary();  // this VTK cannot read appended data back
  if (!writer->Write() || writer->GetErrorCode() != 0)
    throw FileError(file, "it cannot be written", "Is there space on the disk?");
}

}  // namespace surf::io::vtk
