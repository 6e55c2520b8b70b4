// SPDX-License-Identifier: GPL-3.0-or-later
// Writes VTK's image files; vti_read.cpp reads them.
#include <fmt/format.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLImageDataWriter.h>

#include <algorithm>

#include "surf/core/error.h"
#include "vtk_functions.h"
#include "vtk_support.h"

namespace surf::io::vtk {
namespace {

void add_channel(vtkImageData* data, const Channel& channel) {
  vtkNew<vtkFloatArray> array;
  array->SetName(channel.name.c_str());
  array->SetNumberOfTuples(static_cast<vtkIdType>(channel.values.size()));
  std::copy(channel.values.data().begin(), channel.values.data().end(), array->GetPointer(0));
  data->GetPointData()->AddArray(array);
}

vtkNew<vtkImageData> to_vtk(const Image& image) {
  vtkNew<vtkImageData> data;
  data->SetDimensions(image.width(), image.height(), 1);
  data->SetOrigin(image.origin_x_nm, image.origin_y_nm, 0);
  data->SetSpacing(image.pitch_x_nm, image.pitch_y_nm, 1);
  for (const Channel& channel : image.channels) add_channel(data, channel);
  data->GetPointData()->SetActiveScalars(image.channels.front().name.c_str());
  for (const auto& [key, value] : to_attributes(image)) add_text(data->GetFieldData(), key, value);
  return data;
}

/// `target` empty: to a string, which is returned.
std::string write_data(const std::filesystem::path& target, const std::string& file,
                       const Image& image) {
  const auto data = to_vtk(image);
  VtkComplaints complaints;
  vtkNew<vtkXMLImageDataWriter> writer;
  complaints.listen_to(writer.GetPointer());
  if (target.empty()) writer->WriteToOutputStringOn();
  else writer->SetFileName(target.c_str());
  writer->SetInputData(data);
  writer->SetDataModeToBinary();  // ParaView 5.11 on Debian 12 cannot read appended data
  if (writer->Write() != 1 || writer->GetErrorCode() != 0 || !complaints.text().empty()) {
    throw FileError(
        file,
        fmt::format("it cannot be written: error {} {}", writer->GetErrorCode(), complaints.text()),
        "Check the free space, or choose another place");
  }
  return target.empty() ? writer->GetOutputString() : std::string{};
}

}  // namespace

void write_vti(const std::filesystem::path& target, const std::string& file, const Image& image) {
  write_data(target, file, image);
}

std::string vti_content(const std::string& file, const Image& image) {
  return write_data({}, file, image);
}

}  // namespace surf::io::vtk
