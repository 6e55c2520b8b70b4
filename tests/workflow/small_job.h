// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fstream>
#include <sstream>

#include "surf/io/sim/materials.h"
#include "surf/mesh/shapes.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {

/// A 40 nm cube of silicon on silicon, 12 x 9 pixels of 5 nm, 20 electrons each.
inline SimulateJob small_job() {
  SimulateJob job;
  job.scene.title = "small";
  job.scene.specimen.materials = {io::find_material("Si", "test")};
  job.scene.specimen.materials[0].loss_join_fitted = true;  // no warning, whatever the table says
  job.scene.specimen.substrate = mc::Substrate{0, 0.0};
  job.scene.specimen.bodies = {{"folder/cube", make_box({-20, -20, 0}, {20, 20, 40}), 0}};
  job.scene.scan.width = 12;
  job.scene.scan.height = 9;
  job.scene.scan.pixel_x_nm = job.scene.scan.pixel_y_nm = 5;
  job.scene.budget = mc::ElectronsPerPixel{20};
  job.execution.threads = 1;
  job.command_line = "semsurf simulate 'a cube'";
  return job;
}

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

}  // namespace surf::workflow
