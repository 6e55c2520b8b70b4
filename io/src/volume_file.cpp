// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/volume_file.h"

#include "surf/core/error.h"
#include "surf/io/files.h"

#ifdef SEMSURF_HAS_VTK

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkStringArray.h>
#include <vtkXMLImageDataWriter.h>

#endif

namespace surf::io {

#ifdef SEMSURF_HAS_VTK

namespace {

void add_text(vtkFieldData* fields, const std::string& name, const std::string& value) {
  vtkNew<vtkStringArray> array;
  array->SetName(name.c_str());
  array->InsertNextValue(value);
  fields->AddArray(array);
}

}  // namespace

void write_volume(const std::filesystem::path& path, const Volume& volume) {
  if (path.extension() != ".vti")
    throw UsageError(path.string(), "volumes are written as VTI", "Choose a name ending in .vti");
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

  write_atomically(path, [&](const std::filesystem::path& temporary) {
    vtkNew<vtkXMLImageDataWriter> writer;
    writer->SetFileName(temporary.c_str());
    writer->SetInputData(data);
    writer->SetDataModeToBinary();   // this VTK cannot read appended data back
    if (!writer->Write() || writer->GetErrorCode() != 0)
      throw FileError(path.string(), "it cannot be written", "Is there space on the disk?");
  });
}

#else

void write_volume(const std::filesystem::path& path, const Volume&) {
  throw Unsupported(path.string(), "this build has no VTK to write it with",
                    "Build with SEMSURF_VTK=ON");
}

#endif

}  // namespace surf::io
