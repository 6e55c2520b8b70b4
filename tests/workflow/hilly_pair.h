// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "surf/afm/morphology.h"
#include "surf/afm/tip_shapes.h"
#include "surf/io/files.h"
#include "surf/io/height_field_file.h"
#include "surf/io/model/model_file.h"
#include "surf/mesh/shapes.h"
#include "surf/sem/slope_model.h"
#include "surf/workflow/reconstruct_job.h"
#include "temporary_folder.h"

namespace surf::workflow {

inline constexpr Affine shift{1, 0, 60, 0, 1, 45};  // of the SEM image in the scan
inline constexpr double pitch = 5;

/// A hilly place, seen by a dull tip and by a model of 1 / cos with known gains; the SEM image
/// shows the middle of it.
class HillyPair : public testing::Test {
 protected:
  HillyPair() {
    TrainedModel model;
    model.scope = {pitch, "Si", 1000, 0};
    model.parameters =
        SlopeModelParameters{SlopeForm::secant, 5, {5, 0.6}, {{"SE", 0.9, {}}, {"BSE", 0.2, {}}}};
    model.record.range.slope_deg_max = 80;
    io::write_model(path("si.json"), model);
    HeightField truth = make_rough({395, 295, pitch}, 10, 40, 3);
    truth.origin_x_nm = truth.origin_y_nm = 0;
    const AfmNoise noise{0.5, 0.05};
    HeightField scan = dilate(truth, conical_tip(20, 0.4, {pitch, pitch, 9, 9}));
    const Grid<double> added = simulate_noise(noise, scan.z_nm.width(), scan.z_nm.height(), 5);
    for (std::size_t i = 0; i < added.size(); ++i) scan.z_nm.data()[i] += added.data()[i];
    truth_ = truth;
    job_.afm = AfmInput{scan, path("scan.txt"), {}};
    io::write_height_field(path("scan.txt"), scan);
    job_.afm->preparation.level.method = LevelMethod::none;
    job_.afm->preparation.noise = noise;
    job_.afm->preparation.tip = conical_tip(20, 0.4, {pitch, pitch, 9, 9});
    job_.sem = SemInput{sem_image(io::read_model(path("si.json"))), path("sem.txt")};
    io::write_text(path("sem.txt"), "the image");
    job_.model.file = path("si.json");
    job_.pose.transform = shift;
    job_.sem_noise = SemNoise{0, 4, 1e-3};
    job_.folder = path("result");
    job_.picture = false;
    job_.corrections = 0;
    job_.tilt = SemTilt{};
    job_.upsample = 1;
    job_.options.scales_px = {4, 1};
    job_.options.iterations = 8;
    job_.options.probes = 2;
    job_.options.threads = 1;
  }

  PlacedImage sem_image(const TrainedModel& trained) const {
    const ModelImages images = make_model(trained)->predict(truth_);
    PlacedImage sem;
    sem.pitch_x_nm = sem.pitch_y_nm = pitch;
    sem.values = Grid<double>(50, 40);
    const Grid<double> noise = simulate_noise({0, 4}, 50, 40, 9);
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 50; ++x)
        sem.values(x, y) =
            100 * images[0](x + 12, y + 9) + 100 * images[1](x + 12, y + 9) + 20 + noise(x, y);
    return sem;
  }

  StoredModel model() const {
    ModelRequest request = job_.model;
    request.pixel_nm = pitch;
    return find_model(request, {});
  }

  std::filesystem::path path(const char* name) const { return folder_.path() / name; }
  nlohmann::json report(const char* folder) const {
    return nlohmann::json::parse(io::read_file(path(folder) / "report.json"));
  }

  test::TemporaryFolder folder_;
  HeightField truth_;
  ReconstructJob job_;
};

}  // namespace surf::workflow
