// SPDX-License-Identifier: GPL-3.0-or-later
#include "read_input.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "surf/core/error.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/mesh_file.h"
#include "surf/io/model/model_file.h"
#include "surf/io/sem_file.h"
#include "surf/io/sim/scene_file.h"
#include "surf/io/surface_file.h"

namespace surf::test {
namespace {

template <class Data>
void expect_valid(const Data& data) {
  try {
    validate(data);
  } catch (const Error& error) {
    throw std::logic_error(std::string("a reader returned what is invalid: ") + error.what());
  }
}

/// Every channel as heights; what a file has too much of is left out.
void read_channels(const std::filesystem::path& path) {
  constexpr std::size_t most = 8;
  const std::size_t channels = std::min(io::height_channels(path).size(), most);
  for (std::size_t i = 1; i <= channels; ++i)
    expect_valid(io::read_height_field(path, {std::to_string(i), 2.0, {}, {}}).field);
}

bool is_scan_name(const std::filesystem::path& path) {
  for (const char* extension : {".gwy", ".gsf", ".spm", ".ibw", ".nid", ".sxm", ".stp", ".jpk"})
    if (path.extension() == extension) return true;
  return false;
}

void read(const std::filesystem::path& path) {
  if (io::is_scene_file(path)) {
    io::read_scene(path);
  } else if (path.extension() == ".json") {
    io::read_model(path);
  } else if (io::is_height_field_file(path)) {
    read_channels(path);
  } else if (is_scan_name(path)) {
    return;  // its mark is damaged: Gwyddion would be asked, whose process takes long
  } else if (io::is_image_file(path)) {
    expect_valid(io::read_image(path));
    io::is_sem_image_file(path);
    io::SemReadOptions options;
    options.pixel_x_nm = 1;
    expect_valid(io::read_sem_image(path, options).image);
  } else {
    expect_valid(io::read_mesh(path));
    expect_valid(io::read_surfaces(path));
  }
}

}  // namespace

bool read_input(const std::filesystem::path& path) {
  try {
    read(path);
    return true;
  } catch (const Error& error) {
    if (error.reason().empty() || error.remedy().empty()) {
      throw std::logic_error(std::string("an error does not say enough: ") + error.what());
    }
    return false;
  }
}

}  // namespace surf::test
