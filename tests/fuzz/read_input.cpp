// SPDX-License-Identifier: GPL-3.0-or-later
#include "read_input.h"

#include <stdexcept>

#include "surf/core/error.h"
#include "surf/io/image_file.h"
#include "surf/io/mesh_file.h"
#include "surf/io/sim/scene_file.h"

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

void read(const std::filesystem::path& path) {
  if (io::is_scene_file(path)) {
    io::read_scene(path);
  } else if (io::is_image_file(path)) {
    expect_valid(io::read_image(path));
  } else {
    expect_valid(io::read_mesh(path));
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
