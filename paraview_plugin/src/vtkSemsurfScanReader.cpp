// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfScanReader.h"

#include <fmt/format.h>
#include <vtkDataArraySelection.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "attempt.h"
#include "checks.h"
#include "convert/arrays.h"
#include "pipeline.h"
#include "surf/core/error.h"
#include "surf/io/height_field_file.h"

vtkStandardNewMacro(vtkSemsurfScanReader);

using namespace surf;

/// What is known of the file, read once as long as it and the properties stay as they are.
struct vtkSemsurfScanReader::Contents {
  struct Channel {
    std::string name;  // unique
    int number = 1;    // in the file, from 1
    bool is_height = true;
    std::string unit;
  };
  using Key = std::tuple<std::string, std::filesystem::file_time_type, double, double, double>;

  vtkNew<vtkDataArraySelection> selection;
  Key key;
  std::vector<Channel> channels;
  int width = 0, height = 0;
  std::size_t first = 0;     // of the channels: the one that says where the scan lies
  io::HeightFieldFile head;  // that channel
};

vtkSemsurfScanReader::vtkSemsurfScanReader() : Scan(std::make_unique<Contents>()) {
  this->SetNumberOfInputPorts(0);
}
vtkSemsurfScanReader::~vtkSemsurfScanReader() = default;

vtkDataArraySelection* vtkSemsurfScanReader::GetChannelSelection() { return this->Scan->selection; }

vtkMTimeType vtkSemsurfScanReader::GetMTime() {
  return std::max(this->Superclass::GetMTime(), this->Scan->selection->GetMTime());
}

void vtkSemsurfScanReader::SetFileName(const char* name) {
  const std::string value = name ? name : "";
  if (value == this->FileName) return;
  this->FileName = value;
  this->Modified();
}

int vtkSemsurfScanReader::CanReadFile(const char* name) {
  try {
    return io::is_height_field_file(name) ? 1 : 0;
  } catch (const std::exception&) {
    return 0;
  }
}

namespace {

io::HeightReadOptions options_for(int number, double z_unit_nm, const double* pixel_size_nm) {
  io::HeightReadOptions options;
  options.channel = fmt::format("{}", number);
  if (z_unit_nm > 0) options.z_unit_nm = z_unit_nm;
  if (pixel_size_nm[0] > 0) options.pitch_x_nm = pixel_size_nm[0];
  if (pixel_size_nm[1] > 0) options.pitch_y_nm = pixel_size_nm[1];
  return options;
}

std::string unique_name(std::set<std::string>& taken, const std::string& name) {
  std::string candidate = name.empty() ? pv::heights_name : name;
  const std::string base = candidate;
  for (int number = 2; !taken.insert(candidate).second; ++number)
    candidate = fmt::format("{} {}", base, number);
  return candidate;
}

}  // namespace

void vtkSemsurfScanReader::ReadHead() {
  if (this->FileName.empty()) throw UsageError("FileName", "no file is named", "Name a scan");
  pv::need_length(this->ZUnit, "Height Unit");
  for (const double nm : this->PixelSize) pv::need_length(nm, "Pixel Size");
  std::error_code unreadable;  // then reading says what is wrong
  const Contents::Key key{this->FileName,
                          std::filesystem::last_write_time(this->FileName, unreadable), this->ZUnit,
                          this->PixelSize[0], this->PixelSize[1]};
  Contents& scan = *this->Scan;
  if (!scan.channels.empty() && scan.key == key) return;
  scan.channels.clear();
  const std::vector<io::HeightChannel> all = io::height_channels(this->FileName);
  if (all.empty()) throw InvalidInput(this->FileName, "it has no channels", "Export it again");
  auto first = std::ranges::find_if(all, &io::HeightChannel::is_height);
  if (first == all.end()) first = all.begin();
  const int number = static_cast<int>(first - all.begin()) + 1;
  // What is no height is read as the numbers that the file holds.
  const auto unit_of = [&](const io::HeightChannel& c) { return c.is_height ? this->ZUnit : 1.0; };
  scan.head =
      io::read_height_field(this->FileName, options_for(number, unit_of(*first), this->PixelSize));
  for (const std::string& note : scan.head.notes) pv::warn(this, this->FileName + ": " + note);
  scan.width = scan.head.field.z_nm.width();
  scan.height = scan.head.field.z_nm.height();

  std::set<std::string> names{pv::mask_name};
  std::string left_out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].width != first->width || all[i].height != first->height) {
      left_out += (left_out.empty() ? "" : ", ") + all[i].name;
      continue;
    }
    const int here = static_cast<int>(i) + 1;
    if (here == number) scan.first = scan.channels.size();
    scan.channels.push_back({unique_name(names, all[i].name), here, all[i].is_height,
                             all[i].is_height ? "nm" : all[i].z_unit});
  }
  if (!left_out.empty())
    pv::warn(this, fmt::format("{}: left out, as they have another size than '{}': {}",
                               this->FileName, first->name, left_out));
  // Those of another file go; what the user chose of the same names stays.
  std::set<std::string> here;
  for (const auto& channel : scan.channels) here.insert(channel.name);
  for (int i = scan.selection->GetNumberOfArrays() - 1; i >= 0; --i)
    if (!here.contains(scan.selection->GetArrayName(i))) scan.selection->RemoveArrayByIndex(i);
  for (const auto& channel : scan.channels) scan.selection->AddArray(channel.name.c_str(), true);
  scan.key = key;
}

int vtkSemsurfScanReader::RequestInformation(vtkInformation*, vtkInformationVector**,
                                             vtkInformationVector* outputs) {
  return pv::attempt_information(this, outputs, [&] {
    this->ReadHead();
    pv::announce(outputs->GetInformationObject(0),
                 pv::frame_of(this->Scan->head.field.z_nm, this->Scan->head.field));
  });
}

int vtkSemsurfScanReader::RequestData(vtkInformation*, vtkInformationVector**,
                                      vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    this->ReadHead();
    const Contents& scan = *this->Scan;
    const auto image = pv::make_image(pv::frame_of(scan.head.field.z_nm, scan.head.field));
    std::vector<io::HeightFieldFile> read(scan.channels.size());
    const auto wanted = [&](std::size_t i) {
      return scan.selection->ArrayIsEnabled(scan.channels[i].name.c_str());
    };
    pv::work(this, [&](const Watch& watch) {
      for (std::size_t i = 0; i < read.size(); ++i) {
        watch.report(double(i), double(read.size()));
        if (!wanted(i)) continue;
        if (i == scan.first) read[i] = scan.head;
        else
          read[i] = io::read_height_field(
              this->FileName,
              options_for(scan.channels[i].number, scan.channels[i].is_height ? this->ZUnit : 1.0,
                          this->PixelSize));
      }
    });
    std::string shown;
    for (std::size_t i = 0; i < read.size(); ++i) {
      if (!wanted(i)) continue;
      pv::add_heights(image, std::move(read[i].field), scan.channels[i].name);
      pv::set_unit(image->GetPointData()->GetArray(scan.channels[i].name.c_str()),
                   scan.channels[i].unit.c_str());
      if (shown.empty() || i == scan.first) shown = scan.channels[i].name;
    }
    if (!shown.empty()) image->GetPointData()->SetActiveScalars(shown.c_str());
    pv::add_texts(image, scan.head.metadata);
    pv::give(outputs->GetInformationObject(0), image);
  });
}
