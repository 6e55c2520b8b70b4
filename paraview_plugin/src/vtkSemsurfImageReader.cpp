// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfImageReader.h"

#include <vtkInformation.h>
#include <vtkInformationVector.h>

#include <filesystem>

#include "attempt.h"
#include "pipeline.h"
#include "surf/core/error.h"

using namespace surf;

struct vtkSemsurfImageReader::Contents {
  vtkSmartPointer<vtkImageData> image;
  vtkMTimeType read_at = 0;  // the reader's own time then
  std::filesystem::file_time_type written_at;
};

vtkSemsurfImageReader::vtkSemsurfImageReader() : File(std::make_unique<Contents>()) {
  this->SetNumberOfInputPorts(0);
}
vtkSemsurfImageReader::~vtkSemsurfImageReader() = default;

void vtkSemsurfImageReader::SetFileName(const char* name) {
  const std::string value = name ? name : "";
  if (value == this->FileName) return;
  this->FileName = value;
  this->Modified();
}

void vtkSemsurfImageReader::ReadOnce() {
  if (this->FileName.empty()) throw UsageError("FileName", "no file is named", "Name one");
  std::error_code unreadable;  // then reading says what is wrong
  const auto written = std::filesystem::last_write_time(this->FileName, unreadable);
  if (this->File->image && this->File->read_at == this->GetMTime() &&
      this->File->written_at == written)
    return;
  this->File->image = this->Read();
  this->File->read_at = this->GetMTime();
  this->File->written_at = written;
}

int vtkSemsurfImageReader::RequestInformation(vtkInformation*, vtkInformationVector**,
                                              vtkInformationVector* outputs) {
  return pv::attempt_information(this, outputs, [&] {
    this->ReadOnce();
    pv::announce(outputs->GetInformationObject(0),
                 pv::frame_of(this->File->image, this->FileName.c_str()));
  });
}

int vtkSemsurfImageReader::RequestData(vtkInformation*, vtkInformationVector**,
                                       vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    this->ReadOnce();
    pv::give(outputs->GetInformationObject(0), this->File->image);
  });
}
