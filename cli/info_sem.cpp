// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "info.h"
#include "surf/core/units.h"
#include "surf/io/sem_file.h"
#include "terminal.h"

namespace surf::cli {
namespace {

void print_values(const PlacedImage& image) {
  double lowest = HUGE_VAL, highest = -HUGE_VAL, sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    if (!image.valid.empty() && !image.valid.data()[i]) continue;
    lowest = std::min(lowest, image.values.data()[i]);
    highest = std::max(highest, image.values.data()[i]);
    sum += image.values.data()[i];
    ++count;
  }
  if (count > 0)
    print_item("signal",
               fmt::format("{:.6g} to {:.6g}, mean {:.6g}", lowest, highest, sum / double(count)));
}

}  // namespace

void print_sem_image(const std::filesystem::path& path) {
  const io::SemFile file = io::read_sem_image(path);
  const PlacedImage& image = file.image;
  for (const std::string& note : file.notes) print_note(note);
  print("{}: SEM image, {}{}\n", path.string(), file.format,
        file.instrument.empty() ? "" : ", " + file.instrument);
  const int width = image.values.width(), height = image.values.height();
  print_item("size",
             fmt::format("{} x {} pixels of {} x {}, {} x {}", width, height,
                         format_length(image.pitch_x_nm, 4), format_length(image.pitch_y_nm, 4),
                         format_length(width * image.pitch_x_nm),
                         format_length(height * image.pitch_y_nm)));
  print_item("from", file.pixel_from);
  if (file.databar_rows > 0)
    print_item("databar", fmt::format("{} rows below, left out", file.databar_rows));
  print_item("numbers", file.bits > 0 ? fmt::format("{} bits", file.bits) : "floats");
  print_values(image);
  if (file.energy_ev) print_item("energy", format_energy(*file.energy_ev));
  if (file.working_distance_nm)
    print_item("distance", format_length(*file.working_distance_nm) + " to the lens");
  if (file.tilt_deg) print_item("tilt", fmt::format("{:.3g} degrees", *file.tilt_deg));
  if (!file.detector.empty()) print_item("detector", file.detector);
  if (file.metadata.empty()) return;
  print("  what the microscope noted\n");
  for (const auto& [key, value] : file.metadata) print("    {:<24}  {}\n", key, value);
}

}  // namespace surf::cli
