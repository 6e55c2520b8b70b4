// SPDX-License-Identifier: GPL-3.0-or-later
#include "monte_carlo.h"

#include <algorithm>

#include "surf/io/sim/materials.h"
#include "surf/mc/cascades/library_source.h"
#include "surf/mc/simulate.h"
#include "surf/sem/image_error.h"

namespace surf::limits {
namespace {

constexpr std::size_t cascades = 4096;

class SharedLibraries : public mc::LibrarySource {
 public:
  std::shared_ptr<const mc::CascadeLibrary> library(const mc::CascadeSettings& settings,
                                                    std::size_t wanted, int threads,
                                                    const Watch& watch) override {
    return kept_.library(settings, std::max(wanted, cascades), threads, watch);
  }

 private:
  mc::FreshLibraries kept_;
};

}  // namespace

TrainingImage monte_carlo(const HeightField& surface, const Exposure& e) {
  static SharedLibraries libraries;
  mc::Specimen specimen;
  specimen.materials = {io::find_material(e.material, "limits")};
  specimen.materials.front().density_g_cm3 *= e.density;
  specimen.height_field = mc::HeightFieldBody{"surface", surface, 0, Edge::mirror};
  mc::Beam beam;
  beam.energy_ev = e.energy_ev;
  mc::Scan scan;
  scan.width = surface.z_nm.width();
  scan.height = surface.z_nm.height();
  scan.pixel_x_nm = surface.pitch_x_nm;
  scan.pixel_y_nm = surface.pitch_y_nm;
  scan.center_x_nm = surface.origin_x_nm + 0.5 * (scan.width - 1) * surface.pitch_x_nm;
  scan.center_y_nm = surface.origin_y_nm + 0.5 * (scan.height - 1) * surface.pitch_y_nm;
  mc::SimulationOptions options;
  options.method = mc::Method::replay;
  options.budget = mc::ElectronsPerPixel{e.electrons};
  options.seed = e.seed;
  options.detectors = e.detectors;
  const mc::Scene scene(specimen, beam, scan, mc::Physics{});
  const mc::SimulationResult r = mc::simulate(scene, options, {.libraries = &libraries});
  TrainingImage out;
  out.name = "surface";
  out.field = surface;
  for (std::size_t d = 0; d < e.detectors.size(); ++d) {
    Grid<float> image(scan.width, scan.height), errors(scan.width, scan.height);
    for (int y = 0; y < scan.height; ++y)
      for (int x = 0; x < scan.width; ++x) {
        const mc::Estimate yield = r.yield(d, x, y);
        image(x, y) = static_cast<float>(yield.mean);
        // No electron at all: as if there had been one.
        errors(x, y) = static_cast<float>(
            std::max(yield.standard_error, 1.0 / static_cast<double>(e.electrons)));
      }
    out.images.push_back(std::move(image));
    out.standard_errors.push_back(std::move(errors));
  }
  return out;
}

double error_beyond_noise(const Grid<double>& predicted, const TrainingImage& truth,
                          std::size_t channel) {
  const auto as_double = [](const Grid<float>& g) {
    return std::vector<double>(g.data().begin(), g.data().end());
  };
  return image_error(predicted.data(), {}, as_double(truth.images.at(channel)),
                     as_double(truth.standard_errors.at(channel)))
      .beyond_noise;
}

}  // namespace surf::limits
