// SPDX-License-Identifier: GPL-3.0-or-later
// Whether images of a fast model change with the surface as those of long simulations do, upright
// and tilted, by detector:
//   bench_gradients MODEL.json [ELECTRONS [TILT_DEG]]
// A hilly surface of the model's material is simulated twice, the second time with hills of 2 nm
// added, by the same random numbers. What the images change by is compared with the model's J dz:
// its size over the simulation's (1 is right) and the correlation, both without chance.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "surf/afm/resample.h"
#include "surf/core/random.h"
#include "surf/io/cache.h"
#include "surf/io/model/model_file.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/simulate.h"
#include "surf/mesh/shapes.h"
#include "surf/reconstruction/view.h"
#include "surf/workflow/libraries.h"
#include "surf/workflow/stored_model.h"
#include "surf/workflow/train_job.h"

namespace {

using namespace surf;

constexpr int columns = 64, rows = 48, margin = 24;
constexpr int groups = 4;  // of independent seeds, to know the chance by

/// Hills of 2 nm, a few pixels wide.
Grid<double> hills(const HeightField& field) {
  Grid<double> dz(field.z_nm.width(), field.z_nm.height());
  RandomStream random(5, 0, 0);
  for (int i = 0; i < 30; ++i) {
    const double x0 = margin + columns * random.uniform(), y0 = margin + rows * random.uniform(),
                 size = 2 + 3 * random.uniform(), height = random.uniform() < 0.5 ? -2 : 2;
    for (int y = 0; y < dz.height(); ++y)
      for (int x = 0; x < dz.width(); ++x)
        dz(x, y) +=
            height * std::exp(-0.5 * (std::pow((x - x0) / size, 2) + std::pow((y - y0) / size, 2)));
  }
  return dz;
}

struct Setting {
  TrainedModel model;
  std::vector<mc::Detector> detectors;
  std::int64_t electrons = 0;
  double tilt_deg = 0;
};

mc::SimulationResult image_of(const Setting& s, const HeightField& field, int group,
                              mc::LibrarySource& libraries) {
  const ModelScope& scope = s.model.scope;
  mc::Specimen specimen;
  specimen.materials = {io::find_material(scope.material, "bench")};
  const int fine =
      workflow::samples_per_pixel(specimen.materials[0], scope.energy_ev, scope.pixel_nm);
  specimen.height_field =
      mc::HeightFieldBody{"surface", smoothly_upsampled(field, fine), 0, Edge::mirror};
  mc::Beam beam;
  beam.energy_ev = scope.energy_ev;
  beam.spot_nm = scope.spot_nm;
  beam.tilt_deg = s.tilt_deg;
  mc::Scan scan;
  scan.width = columns, scan.height = rows;
  scan.pixel_x_nm = scan.pixel_y_nm = scope.pixel_nm;
  scan.center_x_nm = field.x_nm(margin) + 0.5 * (columns - 1) * scope.pixel_nm;
  scan.center_y_nm = field.y_nm(margin) + 0.5 * (rows - 1) * scope.pixel_nm;
  // A tilted scan's plane goes through the middle of the region at z = 0.
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{s.electrons / groups};
  options.method = mc::Method::replay;
  options.detectors = s.detectors;
  options.seed = 10 + static_cast<std::uint64_t>(group);
  return mc::simulate(mc::Scene(specimen, beam, scan), options, {.libraries = &libraries});
}

/// The model's change at the simulated pixels.
ModelImages model_change(const Setting& s, const HeightField& field, const HeightField& other) {
  const auto model = make_model(s.model);
  // What the beam sees, on the pixels of the simulated image with a margin.
  PlacedImage view;
  view.pitch_x_nm = view.pitch_y_nm = s.model.scope.pixel_nm;
  const BeamAxes axes = beam_axes(s.tilt_deg, 0);
  const Vec3 middle{field.x_nm(margin) + 0.5 * (columns - 1) * view.pitch_x_nm,
                    field.y_nm(margin) + 0.5 * (rows - 1) * view.pitch_y_nm, 0};
  view.values = Grid<double>(columns, rows);
  view.origin_x_nm = dot(middle, axes.across) - 0.5 * (columns - 1) * view.pitch_x_nm;
  view.origin_y_nm = dot(middle, axes.up) - 0.5 * (rows - 1) * view.pitch_y_nm;
  constexpr int around = 12;
  const ViewPose pose{s.tilt_deg, 0, {}};
  HeightField before = heights_along_beam(field, view, pose, around),
              after = heights_along_beam(other, view, pose, around);
  before.valid = after.valid = {};
  Grid<double> dz = after.z_nm;
  for (std::size_t i = 0; i < dz.size(); ++i) dz.data()[i] -= before.z_nm.data()[i];
  ModelImages out;
  for (const Grid<double>& image : model->linearize(before)->change(dz)) {
    Grid<double> middle_part(columns, rows);
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x) middle_part(x, y) = image(x + around, y + around);
    out.push_back(std::move(middle_part));
  }
  return out;
}

double product(const Grid<double>& a, const Grid<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a.data()[i] * b.data()[i];
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "bench_gradients MODEL.json [ELECTRONS [TILT_DEG]]\n");
    return 2;
  }
  Setting s;
  s.model = io::read_model(argv[1]);
  s.electrons = argc > 2 ? std::atol(argv[2]) : 4000;
  s.tilt_deg = argc > 3 ? std::atof(argv[3]) : 0;
  s.detectors = mc::default_detectors();
  for (const mc::Detector& d : workflow::taught_by(s.model)) s.detectors.push_back(d);
  workflow::CachedLibraries libraries(io::cache_folder(""));

  const double pitch = s.model.scope.pixel_nm;
  HeightField field =
      make_rough({(columns + 2 * margin - 1) * pitch, (rows + 2 * margin - 1) * pitch, pitch},
                 4 * pitch / 3, 5 * pitch, 3);
  HeightField other = field;
  const Grid<double> dz = hills(field);
  for (std::size_t i = 0; i < dz.size(); ++i) other.z_nm.data()[i] += dz.data()[i];

  std::vector<std::vector<Grid<double>>> changes(s.detectors.size());  // [detector][group]
  for (int group = 0; group < groups; ++group) {
    const mc::SimulationResult a = image_of(s, field, group, libraries),
                               b = image_of(s, other, group, libraries);
    for (std::size_t d = 0; d < s.detectors.size(); ++d) {
      Grid<double>& change = changes[d].emplace_back(columns, rows);
      for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
          change(x, y) = b.yield(d, x, y).mean - a.yield(d, x, y).mean;
    }
  }
  const ModelImages predicted = model_change(s, field, other);
  const auto model = make_model(s.model);
  fmt::print("tilt {:g} deg, {} electrons per pixel\n", s.tilt_deg, s.electrons);
  fmt::print("  detector      model's change over the simulation's   correlation\n");
  for (std::size_t d = 0; d < s.detectors.size(); ++d) {
    const auto c = std::ranges::find(model->channels(), s.detectors[d].name);
    if (c == model->channels().end()) continue;
    const Grid<double>& own = predicted[static_cast<std::size_t>(c - model->channels().begin())];
    // Products of different groups have no chance in common.
    double truth2 = 0, both = 0;
    std::vector<double> ratios;
    for (int i = 0; i < groups; ++i) {
      both += product(own, changes[d][static_cast<std::size_t>(i)]) / groups;
      ratios.push_back(product(own, own) / product(own, changes[d][static_cast<std::size_t>(i)]));
      for (int k = 0; k < i; ++k)
        truth2 += product(changes[d][static_cast<std::size_t>(i)],
                          changes[d][static_cast<std::size_t>(k)]) /
                  (groups * (groups - 1) / 2);
    }
    double mean = 0, spread = 0;
    for (const double r : ratios) mean += r / groups;
    for (const double r : ratios) spread += (r - mean) * (r - mean) / (groups - 1) / groups;
    fmt::print("  {:12}  {:.3f} +- {:.3f}                           {:.3f}\n", s.detectors[d].name,
               std::sqrt(product(own, own) / truth2), std::sqrt(spread),
               both / std::sqrt(product(own, own) * truth2));
  }
}
