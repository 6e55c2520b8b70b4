// SPDX-License-Identifier: GPL-3.0-or-later
// Uses something of every library, so that every library and what it needs gets linked.
#include <cstdio>

#include "surf/core/units.h"
#include "surf/io/image_file.h"
#include "surf/io/mesh_file.h"
#include "surf/io/sim/materials.h"
#include "surf/io/track_picture.h"
#include "surf/io/tracks_file.h"
#include "surf/mc/physics/physics.h"
#include "surf/workflow/simulate_job.h"

int main() {
  using namespace surf;
  const auto& silicon = io::find_material("Si", "material");
  const auto scan =
      workflow::resolve_scan({.width = 8, .height = 8}, {{0, 0, 0}, {80, 80, 10}}, {});
  std::printf("%s, %zu mechanisms, %s a pixel\n", silicon.name.c_str(),
              mc::describe({}, silicon).size(), format_length(scan.pixel_x_nm).c_str());
  // Modules are linked, not looked for beside this program: else these throw.
  io::check_image_target("a.exr");
  io::check_tracks_target("a.vtp");
  io::check_track_picture_target("a.png");
  // Not run, but linked: what these need inside has to be found.
  if (scan.width < 0) {
    io::write_tracks("a.vtp", {});
    io::write_track_picture("a.png", {});
    io::write_mesh("a.vtp", io::read_mesh("a.glb"));
  }
  return io::is_image_file("a.exr") ? 0 : 1;
}
