// SPDX-License-Identifier: GPL-3.0-or-later
// How fast the simulator is, as JSON: flat silicon and the thesis's mesa at 1 keV with full
// secondary cascades, one and two threads; cost against the number of triangles; electrons lost on
// the closed samples; and the floor: what the ray tracer and the scattering cost on their own.
//   bench_simulate [--quick] [output.json]
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "geometry/embree_scene.h"
#include "scenes.h"
#include "surf/core/random.h"
#include "surf/mc/physics/medium.h"
#include "surf/mc/simulate.h"
#include "surf/mc/transport/boundary.h"
#include "surf/mc/transport/energy_deposit.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/shapes.h"

namespace {

using namespace surf;
using nlohmann::json;

constexpr double target_per_thread = 50000;  // primaries per second on the mesa

using bench::silicon;
using bench::view;

mc::Specimen flat() { return bench::flat(silicon()); }
mc::Specimen mesa() { return bench::mesa(silicon()); }

struct Run {
  mc::SimulationResult result;
  mc::SceneSummary scene;
};

struct Settings {
  mc::Physics physics = {};
  std::vector<std::string> detectors = {};  // besides SE and BSE
  bool spectra = false;
  bool deposit = false;  // energy on a grid of 64 cells
  std::size_t grid_bytes = mc::SceneOptions{}.distance_grid_bytes;
};

Run simulate(const mc::Specimen& specimen, const mc::Scan& scan, std::int64_t electrons,
             int threads, const Settings& settings = {}) {
  const mc::Scene scene(specimen, {}, scan, settings.physics, {settings.grid_bytes});
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{electrons};
  options.threads = threads;
  options.spectra = settings.spectra;
  for (const std::string& text : settings.detectors)
    for (const mc::Detector& d : mc::parse_detectors(text, "bench")) options.detectors.push_back(d);
  if (!settings.deposit) return {mc::simulate(scene, options), scene.summary()};
  std::vector<mc::EnergyDeposit> deposits(static_cast<std::size_t>(threads),
                                          mc::EnergyDeposit(mc::deposit_grid(scene, 64)));
  return {
      mc::simulate(
          scene, options,
          {.observers = [&](int thread) { return &deposits[static_cast<std::size_t>(thread)]; }}),
      scene.summary()};
}

json report(const Run& run) {
  const mc::Balance& b = run.result.balance;
  const double n = static_cast<double>(b.incident);
  return {{"primaries", b.incident},
          {"seconds", run.result.seconds},
          {"primaries_per_second", n / run.result.seconds},
          {"rays_per_second", static_cast<double>(b.rays) / run.result.seconds},
          {"steps_per_primary", static_cast<double>(b.steps) / n},
          {"rays_per_primary", static_cast<double>(b.rays) / n},
          {"secondaries_per_primary", static_cast<double>(b.generated) / n},
          {"nanoseconds_per_step", 1e9 * run.result.seconds / static_cast<double>(b.steps)},
          {"se_yield", static_cast<double>(b.se) / n},
          {"bse_yield", static_cast<double>(b.bse) / n},
          {"triangles", run.scene.triangles},
          {"grid_cell_nm", run.scene.grid_cell_nm},
          {"memory_bytes", run.scene.memory_bytes},
          {"build_seconds", run.scene.build_seconds},
          {"lost", b.total_lost()}};
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// What the parts cost on their own, on one thread: the ray tracer with rays as short as steps are,
// started near the mesa's surface, and with rays from above; scattering in an endless medium.
json floor_costs(bool quick) {
  const TriangleMesh mesh = half_space_top(make_mesa({398, 398, 2}, 200, 80, 2), 1000);
  const mc::EmbreeScene rays(mesh);
  const auto accept = [](void*, std::uint32_t, double, double) { return true; };
  RandomStream random(1, 0, 0);
  const int n = quick ? 200000 : 3000000;
  std::vector<std::pair<Vec3, Vec3>> lines;
  for (int i = 0; i < 4096; ++i) {
    const double c = 1 - 2 * random.uniform(), f = 6.283185307 * random.uniform();
    const double s = std::sqrt(1 - c * c);
    lines.push_back(
        {{192 * (random.uniform() - 0.5), 192 * (random.uniform() - 0.5), -2 * random.uniform()},
         {s * std::cos(f), s * std::sin(f), c}});
  }
  mc::EmbreeScene::Hit hit;
  auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < n; ++i) {
    const auto& [from, to] = lines[static_cast<std::size_t>(i % 4096)];
    rays.nearest(from, to, 0.7, accept, nullptr, hit);
  }
  const double short_ns = 1e9 * seconds_since(begin) / n;
  begin = std::chrono::steady_clock::now();
  for (int i = 0; i < n; ++i) {
    Vec3 from = lines[static_cast<std::size_t>(i % 4096)].first;
    from.z = 201;
    rays.nearest(from, {0, 0, -1}, HUGE_VAL, accept, nullptr, hit);
  }
  const double long_ns = 1e9 * seconds_since(begin) / n;

  const mc::Medium medium = mc::make_medium(io::find_material("Si", "bench"), {});
  const mc::CustomSpecimen endless{
      {&medium},
      [](const Vec3&, const Vec3&, double, int) { return std::optional<mc::BoundaryHit>(); },
      {}};
  begin = std::chrono::steady_clock::now();
  const mc::CustomResult r = mc::simulate_custom(endless, {}, {0, 0, -1}, 1000, 0,
                                                 mc::BarrierModel::quantum, 1, quick ? 500 : 10000);
  const double step_ns = 1e9 * seconds_since(begin) / static_cast<double>(r.balance.steps);
  return {{"short_ray_ns", short_ns}, {"long_ray_ns", long_ns}, {"scattering_step_ns", step_ns}};
}

// Time per primary from the costs of the parts, and how far the run is above it.
json against_floor(const json& run, const json& floor) {
  const double steps = run["steps_per_primary"].get<double>();
  const double rays = run["rays_per_primary"].get<double>();
  const double us = 1e-3 * (steps * floor["scattering_step_ns"].get<double>() +
                            (rays - 1) * floor["short_ray_ns"].get<double>() +
                            floor["long_ray_ns"].get<double>());
  const double measured = 1e6 / run["primaries_per_second"].get<double>();
  return {
      {"microseconds_per_primary", measured},
      {"floor_microseconds", us},
      {"scattering_share_of_floor", 1e-3 * steps * floor["scattering_step_ns"].get<double>() / us},
      {"ratio_to_floor", measured / us}};
}

json lost_electrons(bool quick) {
  struct Sample {
    const char* name;
    mc::Specimen specimen;
    double view_nm;
  };
  std::vector<Sample> samples{{"flat", flat(), 100}, {"mesa", mesa(), 192}};
  mc::Specimen cube = flat();
  cube.bodies.push_back({"cube", make_box({-50, -50, 0}, {50, 50, 100}), 0});
  samples.push_back({"cube on its substrate", cube, 160});
  mc::Specimen sphere = flat();
  sphere.bodies.push_back({"sphere", make_sphere({0, 0, 40}, 40, 5), 1});
  samples.push_back({"gold sphere on silicon", sphere, 120});
  mc::Specimen trench = silicon();
  trench.height_field =
      mc::HeightFieldBody{"trench", make_trench({300, 100, 2}, 100, 60, 20), 0, Edge::periodic};
  samples.push_back({"trench", trench, 100});
  mc::Specimen rough = silicon();
  rough.height_field =
      mc::HeightFieldBody{"rough", make_rough({254, 254, 2}, 8, 25, 1), 0, Edge::periodic};
  samples.push_back({"rough", rough, 200});
  json out = json::array();
  std::int64_t electrons = 0, lost = 0;
  for (const Sample& s : samples) {
    const Run run = simulate(s.specimen, view(s.view_nm, 64), quick ? 4 : 60, 0);
    const mc::Balance& b = run.result.balance;
    json causes;
    for (int c = 0; c < mc::loss_causes; ++c)
      causes[mc::name(static_cast<mc::LossCause>(c))] = b.lost[static_cast<std::size_t>(c)];
    electrons += b.incident + b.generated;
    lost += b.total_lost();
    out.push_back({{"sample", s.name}, {"electrons", b.incident + b.generated}, {"lost", causes}});
  }
  return {{"samples", out},
          {"electrons", electrons},
          {"lost", lost},
          {"fraction", static_cast<double>(lost) / static_cast<double>(electrons)},
          {"target", 1e-7}};
}

// What more to watch costs, and what less physics saves (thesis, 5.3.2), beside the full model.
json cost_of_outputs(std::int64_t electrons) {
  mc::Physics without_secondaries;
  mc::parse_physics("secondaries=off", without_secondaries);
  const std::vector<std::string> many{"quadrants", "annular", "in-lens", "side", "SE1", "SE2"};
  const std::vector<std::pair<const char*, Settings>> cases{
      {"SE and BSE", {}},
      {"eleven detectors", {{}, many}},
      {"eleven detectors with spectra", {{}, many, true}},
      {"deposited energy", {{}, {}, false, true}},
      {"secondaries off", {without_secondaries}}};
  json out = json::array();
  double full = 0;
  for (const auto& [name, settings] : cases) {
    json row = report(simulate(mesa(), view(192, 96), electrons, 1, settings));
    const double rate = row["primaries_per_second"];
    if (full == 0) full = rate;
    out.push_back({{"case", name},
                   {"primaries_per_second", rate},
                   {"times_full_model", rate / full},
                   {"se_yield", row["se_yield"]},
                   {"bse_yield", row["bse_yield"]}});
  }
  return out;
}

json cost_against_triangles(bool quick) {
  json out = json::array();
  for (const double triangles : {1e3, 1e4, 1e5, 1e6, 1e7}) {
    if (quick && triangles > 1e5) break;
    const double pitch = 398.0 / std::sqrt(triangles / 2);
    mc::Specimen s = silicon();
    // The same smooth rough surface, sampled more and more finely.
    const int n = static_cast<int>(398.0 / pitch) + 1;
    HeightField f;
    f.z_nm = Grid<double>(n, n);
    f.pitch_x_nm = f.pitch_y_nm = 398.0 / (n - 1);
    f.origin_x_nm = f.origin_y_nm = -199;
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        f.z_nm(x, y) = 10 * std::sin(f.x_nm(x) * 0.05) * std::cos(f.y_nm(y) * 0.06);
    s.height_field = mc::HeightFieldBody{"waves", f, 0, Edge::flat};
    json row = report(simulate(s, view(192, 64), quick ? 4 : 40, 1));
    row["triangles_asked"] = triangles;
    out.push_back(row);
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  bool quick = false;
  std::string path;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--quick") == 0) quick = true;
    else path = argv[i];
  }
  const std::int64_t n = quick ? 10 : 100;
  Settings no_grid;
  no_grid.grid_bytes = 0;
  json out;
  for (const int threads : {1, 2}) {
    const std::string key = std::to_string(threads) + "_threads";
    out["flat"][key] = report(simulate(flat(), view(192, 96), n, threads));
    out["mesa"][key] = report(simulate(mesa(), view(192, 96), n, threads));
    // The alternative, in the same run: every step asks for the surface.
    out["mesa_without_distance_grid"][key] =
        report(simulate(mesa(), view(192, 96), n / 2, threads, no_grid));
  }
  out["mesa"]["target_per_thread"] = target_per_thread;
  out["mesa"]["ratio_to_target"] =
      out["mesa"]["1_threads"]["primaries_per_second"].get<double>() / target_per_thread;
  out["floor"] = floor_costs(quick);
  out["mesa"]["profile"] = against_floor(out["mesa"]["1_threads"], out["floor"]);
  out["cost_of_outputs"] = cost_of_outputs(n);
  out["cost_against_triangles"] = cost_against_triangles(quick);
  out["lost_electrons"] = lost_electrons(quick);
  const std::string text = out.dump(2);
  if (path.empty()) fmt::print("{}\n", text);
  else std::ofstream(path) << text << "\n";
}
