// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfSemReader.h"

#include <fmt/format.h>
#include <vtkObjectFactory.h>

#include <utility>

#include "attempt.h"
#include "checks.h"
#include "convert/image.h"
#include "surf/io/sem_file.h"

vtkStandardNewMacro(vtkSemsurfSemReader);

using namespace surf;

void vtkSemsurfSemReader::SetChannel(const char* name) {
  const std::string value = name ? name : "";
  if (value == this->Channel) return;
  this->Channel = value;
  this->Modified();
}

vtkSmartPointer<vtkImageData> vtkSemsurfSemReader::Read() {
  for (const double nm : this->PixelSize) pv::need_length(nm, "Pixel Size");
  io::SemReadOptions options{.channel = this->Channel, .keep_databar = this->KeepDatabar};
  if (this->PixelSize[0] > 0) options.pixel_x_nm = this->PixelSize[0];
  if (this->PixelSize[1] > 0) options.pixel_y_nm = this->PixelSize[1];
  io::SemFile file = io::read_sem_image(this->FileName, options);
  for (const std::string& note : file.notes) pv::warn(this, this->FileName + ": " + note);
  auto image =
      pv::to_vtk(std::move(file.image), file.channel.empty() ? "signal" : file.channel, "1");
  auto texts = file.metadata;
  const auto add = [&](const char* key, const std::optional<double>& value) {
    if (value) texts[key] = fmt::format("{:.9g}", *value);
  };
  texts["format"] = file.format;
  texts["pixel_from"] = file.pixel_from;
  add("energy_ev", file.energy_ev);
  add("working_distance_nm", file.working_distance_nm);
  add("tilt_deg", file.tilt_deg);
  if (!file.detector.empty()) texts["detector"] = file.detector;
  if (!file.instrument.empty()) texts["instrument"] = file.instrument;
  pv::add_texts(image, texts);
  return image;
}
