// SPDX-License-Identifier: GPL-3.0-or-later
// How long work goes on after it is told to stop: each is stopped at nine points spread over its
// time, on a surface of 1025 x 1025 samples or of a million triangles. ParaView's plugin adds up to
// 0.05 s until it passes an abort on.
//   bench_abort [PART OF A NAME [MODEL.json]]
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "surf/afm/certainty.h"
#include "surf/afm/clean.h"
#include "surf/afm/hough_plane.h"
#include "surf/afm/morphology.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"
#include "surf/io/model/model_file.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/geometry/scene.h"
#include "surf/mc/simulate.h"
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/mesh_height_field.h"
#include "surf/mesh/repair_mesh.h"
#include "surf/mesh/self_intersections.h"
#include "surf/mesh/shapes.h"
#include "surf/mesh/sheet_solid.h"
#include "surf/mesh/simplify_mesh.h"
#include "surf/mesh/thin_height_field.h"
#include "surf/mesh/vertex_curvature.h"

namespace {

using namespace surf;
using Clock = std::chrono::steady_clock;
using Job = std::function<void(const Watch&)>;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Seconds from the word to the end; below 0: it had ended before.
double latency(const Job& job, double after_s) {
  CancelToken cancel;
  Clock::time_point end;
  bool interrupted = false;
  std::thread worker([&] {
    try {
      job({{}, &cancel});
    } catch (const Interrupted&) {
      interrupted = true;
    }
    end = Clock::now();
  });
  std::this_thread::sleep_for(std::chrono::duration<double>(after_s));
  const auto told = Clock::now();
  cancel.cancel();
  worker.join();
  return interrupted || end > told ? std::chrono::duration<double>(end - told).count() : -1;
}

void measure(const std::string& name, const std::string& wanted, const Job& job) {
  if (name.find(wanted) == std::string::npos) return;
  const auto start = Clock::now();
  job({});
  const double whole = seconds_since(start);
  std::vector<double> latencies;
  for (int tenth = 1; tenth < 10; ++tenth)
    if (const double s = latency(job, 0.1 * tenth * whole); s >= 0) latencies.push_back(s);
  std::ranges::sort(latencies);
  if (latencies.empty()) latencies.push_back(0);
  fmt::print("{:<36} {:>8.2f} {:>10.3f} {:>10.3f}\n", name, whole, latencies[latencies.size() / 2],
             latencies.back());
  std::fflush(stdout);
}

mc::Specimen of_silicon(HeightField field) {
  mc::Specimen specimen;
  specimen.materials.push_back(io::find_material("Si", "bench"));
  specimen.height_field = mc::HeightFieldBody{"field", std::move(field), 0, Edge::mirror};
  return specimen;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string wanted = argc > 1 ? argv[1] : "";
  const HeightField field = make_rough({1024, 1024, 1}, 10, 25, 1);
  const TriangleMesh sheet = height_field_sheet(make_rough({708, 708, 1}, 10, 25, 1));
  TriangleMesh torn = sheet;  // holes all over, and vertices that are several
  for (std::size_t t = 0; t < torn.triangles.size(); t += 997)
    torn.triangles[t] = torn.triangles.back();
  const Tip tip = conical_tip(15, 0.35, {1, 1, 31, 31});
  mc::Scan scan;
  scan.width = scan.height = 64;
  scan.pixel_x_nm = scan.pixel_y_nm = 8;
  const mc::Specimen specimen = of_silicon(field);
  // Goes on for micrometres beyond its edge where electrons are fast: 24 GB of samples of 1 nm.
  const mc::Specimen coarse = of_silicon(make_rough({8192, 8192, 32}, 10, 800, 1));
  fmt::print("{} x {} samples, {} triangles\n", field.z_nm.width(), field.z_nm.height(),
             sheet.triangles.size());
  fmt::print("{:<36} {:>8} {:>10} {:>10}\n", "", "whole s", "median s", "longest s");
  measure("find_plane", wanted, [&](const Watch& w) { find_plane(field, {.watch = w}); });
  measure("median_filter 9 x 9", wanted, [&](const Watch& w) {
    CleanSummary summary;
    summary = median_filter(field, {.radius = 4, .watch = w}).summary;
  });
  measure("erode", wanted, [&](const Watch& w) { erode(field, tip, {.watch = w}); });
  measure("certainty_map", wanted,
          [&](const Watch& w) { certainty_map(field, tip, {.watch = w}); });
  measure("thin_height_field", wanted, [&](const Watch& w) {
    ThinSummary summary;
    summary = thin_height_field(field, {.tolerance_nm = 0.1, .watch = w}).summary;
  });
  measure("mean_curvature", wanted, [&](const Watch& w) { mean_curvature(sheet, 0, w); });
  measure("sheet_solid", wanted, [&](const Watch& w) { sheet_solid(sheet, -1000, w); });
  measure("mesh_height_field", wanted,
          [&](const Watch& w) { mesh_height_field(sheet, {.pitch_nm = 0.7, .watch = w}); });
  measure("check_mesh", wanted, [&](const Watch& w) { check_mesh(sheet, w); });
  measure("find_self_intersections", wanted,
          [&](const Watch& w) { find_self_intersections(sheet, {.watch = w}); });
  measure("repair_mesh, sound", wanted, [&](const Watch& w) {
    RepairSummary summary;
    summary = repair_mesh(sheet, {.watch = w}).summary;
  });
  measure("repair_mesh, torn", wanted, [&](const Watch& w) {
    RepairSummary summary;
    summary = repair_mesh(torn, {.watch = w}).summary;
  });
  measure("simplify_mesh to a tenth", wanted, [&](const Watch& w) {
    SimplifySummary summary;
    summary = simplify_mesh(sheet, {.triangles = sheet.triangles.size() / 10, .watch = w}).summary;
  });
  measure("mc::Scene, field", wanted,
          [&](const Watch& w) { mc::Scene(specimen, {}, scan, {}, {.watch = w}); });
  measure("mc::Scene, mesh", wanted, [&](const Watch& w) {
    mc::Specimen of_mesh = specimen;
    of_mesh.height_field.reset();
    of_mesh.bodies.push_back({"sheet", sheet, 0});
    mc::Scene(of_mesh, {}, scan, {}, {.watch = w});
  });
  // Of each the units that were begun are done.
  for (const double energy_ev : {1000.0, 10000.0, 30000.0}) {
    mc::Beam beam;
    beam.energy_ev = energy_ev;
    mc::SimulationOptions options;
    options.budget = mc::ElectronsPerPixel{energy_ev > 1000 ? 100 : 1000};
    const std::string name = fmt::format("mc::simulate, direct, {:g} keV", energy_ev / 1000);
    if (name.find(wanted) == std::string::npos) continue;
    const mc::Scene scene(coarse, beam, scan);
    measure(name, wanted, [&](const Watch& w) {
      mc::simulate(scene, options, {.watch = {{}, w.cancel}});
    });
  }
  if (argc > 2) {
    const TrainedModel trained = io::read_model(argv[2]);
    const auto model = make_model(trained);
    HeightField at_pixel = field;
    at_pixel.pitch_x_nm = at_pixel.pitch_y_nm = trained.scope.pixel_nm;
    measure("predict", wanted, [&](const Watch& w) { model->predict(at_pixel, {.watch = w}); });
  }
}
