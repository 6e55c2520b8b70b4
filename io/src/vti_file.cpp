// SPDX-License-Identifier: GPL-3.0-or-later
// VTK's image files.
#include "image_formats.h"
#include "surf/core/error.h"

#ifdef SEMSURF_HAS_VTK

#include <fmt/format.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkVersion.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLImageDataWriter.h>

#include <algorithm>
#include <utility>

#include "surf/io/files.h"
#include "vtk_support.h"

namespace surf::io {
namespace {

void add_channel(vtkImageData* data, const Channel& channel) {
  vtkNew<vtkFloatArray> array;
  array->SetName(channel.name.c_str());
  array->SetNumberOfTuples(static_cast<vtkIdType>(channel.values.size()));
  std::copy(channel.values.data().begin(), channel.values.data().end(), array->GetPointer(0));
  data->GetPointData()->AddArray(array);
}

Attributes text_fields(vtkFieldData* fields) {
  Attributes attributes;
  for (int i = 0; fields && i < fields->GetNumberOfArrays(); ++i) {
    auto* const array = vtkStringArray::SafeDownCast(fields->GetAbstractArray(i));
    if (!array || !array->GetName() || array->GetNumberOfValues() != 1) continue;
    attributes[array->GetName()] = array->GetValue(0);
  }
  return attributes;
}

void append_array(vtkDataArray* array, int width, int height, Image& image) {
  const int components = array->GetNumberOfComponents();
  const std::string name = array->GetName() ? array->GetName() : "L";
  for (int c = 0; c < components; ++c) {
    Channel channel{components == 1 ? name : fmt::format("{}.{}", name, c), "1",
                    Grid<float>(width, height)};
    for (std::size_t i = 0; i < channel.values.size(); ++i) {
      channel.values.data()[i] =
          static_cast<float>(array->GetComponent(static_cast<vtkIdType>(i), c));
    }
    image.channels.push_back(std::move(channel));
  }
}

/// This VTK reads appended data as nothing at all, without a word (its XML parser's fault).
void refuse_appended(const std::string& content, const std::string& file) {
  if (content.find("<AppendedData") == std::string::npos) return;
  throw FileError(file, "its data is appended, which cannot be read here",
                  "Save it with the data mode Binary or Ascii");
}

void read_into(vtkXMLImageDataReader* reader, const std::string& file) {
  VtkComplaints complaints;
  reader->SetReaderErrorObserver(complaints.command());
  reader->SetParserErrorObserver(complaints.command());
  complaints.listen_to(reader);
  reader->SetFileName(file.c_str());
  reader->Update();
  if (!complaints.text().empty() || reader->GetErrorCode() != 0) {
    throw FileError(file, fmt::format("cannot be read as VTI: {}", complaints.text()),
                    "It is cut off or damaged: copy or write it again");
  }
}

}  // namespace

bool has_vti() { return true; }

std::string vti_library_version() { return fmt::format("VTK {}", vtkVersion::GetVTKVersion()); }

void write_vti(const std::filesystem::path& target, const std::string& file, const Image& image) {
  vtkNew<vtkImageData> data;
  data->SetDimensions(image.width(), image.height(), 1);
  data->SetOrigin(image.origin_x_nm, image.origin_y_nm, 0);
  data->SetSpacing(image.pitch_x_nm, image.pitch_y_nm, 1);
  for (const Channel& channel : image.channels) add_channel(data, channel);
  data->GetPointData()->SetActiveScalars(image.channels.front().name.c_str());
  for (const auto& [key, value] : to_attributes(image)) add_text(data->GetFieldData(), key, value);

  VtkComplaints complaints;
  vtkNew<vtkXMLImageDataWriter> writer;
  complaints.listen_to(writer.GetPointer());
  writer->SetFileName(target.c_str());
  writer->SetInputData(data);
  writer->SetDataModeToBinary();   // ParaView 5.11 on Debian 12 cannot read appended data
  if (writer->Write() != 1 || writer->GetErrorCode() != 0 || !complaints.text().empty()) {
    throw FileError(file, fmt::format("cannot be written: error {} {}", writer->GetErrorCode(),
                                      complaints.text()),
                    "Check the free space, or choose another place");
  }
}

Image read_vti(const std::filesystem::path& path) {
  const std::string file = path.string();
  refuse_appended(read_file(path), file);
  vtkNew<vtkXMLImageDataReader> reader;
  read_into(reader, file);
  vtkImageData* const data = reader->GetOutput();
  int size[3] = {0, 0, 0};
  data->GetDimensions(size);
  if (size[0] < 1 || size[1] < 1 || size[2] != 1) {
    throw FileError(file, fmt::format("{} x {} x {} points are not a picture", size[0], size[1],
                                      size[2]),
                    "Use an image of one layer in z");
  }
  Image image;
  double corner[3] = {0, 0, 0};
  data->GetPoint(0, corner);   // with an extent that does not begin at 0, this is not the origin
  image.origin_x_nm = corner[0];
  image.origin_y_nm = corner[1];
  image.pitch_x_nm = data->GetSpacing()[0];
  image.pitch_y_nm = data->GetSpacing()[1];
  vtkPointData* const points = data->GetPointData();
  for (int i = 0; i < points->GetNumberOfArrays(); ++i) {
    if (vtkDataArray* array = points->GetArray(i)) append_array(array, size[0], size[1], image);
  }
  if (image.channels.empty()) {
    throw FileError(file, "it has no values at its points", "Save point data, not cell data");
  }
  apply_attributes(text_fields(data->GetFieldData()), file, image);
  return image;
}

}  // namespace surf::io

#else

namespace surf::io {
namespace {

[[noreturn]] void refuse(const std::string& file) {
  throw Unsupported(file, "this semsurf was built without VTK, which VTI needs",
                    "Use .exr or .tif, or build with VTK");
}

}  // namespace

bool has_vti() { return false; }

std::string vti_library_version() { return {}; }

void write_vti(const std::filesystem::path&, const std::string& file, const Image&) {
  refuse(file);
}

Image read_vti(const std::filesystem::path& path) { refuse(path.string()); }

}  // namespace surf::io

#endif
