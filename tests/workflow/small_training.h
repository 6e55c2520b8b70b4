// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/io/sim/materials.h"
#include "surf/mesh/shapes.h"
#include "surf/workflow/train_job.h"

namespace surf::workflow {

/// A model of 1 / cos from two of semsurf's own surfaces, 16 pixels of 3 nm across, 3 electrons
/// each.
inline TrainJob small_training(const std::filesystem::path& output) {
  TrainJob job;
  job.surfaces = 2;
  job.surface_px = 16;
  job.pixel_nm = 3;
  job.material = io::find_material("Si", "test");
  job.simulation.budget = mc::ElectronsPerPixel{3};
  job.simulation.threads = 1;
  job.learn.kind = "secant";
  job.output = output;
  return job;
}

/// The same with a rough surface of one's own, of this pitch.
inline TrainJob own_training(const std::filesystem::path& output, double pitch_nm) {
  TrainJob job = small_training(output);
  const double across = 15 * pitch_nm;
  job.inputs = {{"folder/scan.gwy", make_rough({across, across, pitch_nm}, 4, 9, 1), "", {}}};
  return job;
}

}  // namespace surf::workflow
