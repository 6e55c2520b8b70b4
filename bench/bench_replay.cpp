// SPDX-License-Identifier: GPL-3.0-or-later
// How fast replay is beside direct simulation, as JSON: primaries per second on flat silicon, the
// thesis's mesa and closed meshes; cost against the number of triangles; time of an image of a rough
// surface to 1 %; error at equal time against energy; and the floor, the ray tracer's own speed.
//   bench_replay [--quick] [--only WORD] [--data FOLDER] [output.json]
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "surf/core/random.h"
#include "surf/io/mesh_file.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/cascade_library.h"
#include "surf/mc/simulate.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/shapes.h"

namespace {

using namespace surf;
using nlohmann::json;

mc::Specimen silicon() {
  mc::Specimen s;
  s.materials = {io::find_material("Si", "bench")};
  return s;
}

mc::Specimen flat() {
  mc::Specimen s = silicon();
  s.substrate = mc::Substrate{};
  return s;
}

// Seeger's figure 5-6: 79,202 triangles over 398 nm, 200 nm high, 80 nm wide at the top.
mc::Specimen mesa(double pitch_nm = 2) {
  mc::Specimen s = silicon();
  s.height_field =
      mc::HeightFieldBody{"mesa", make_mesa({398, 398, pitch_nm}, 200, 80, 2), 0, Edge::flat};
  return s;
}

// Two crossed waves whose smallest radius of curvature is `radius_nm`.
mc::Specimen waves(double radius_nm, double pitch_nm) {
  mc::Specimen s = silicon();
  const int n = static_cast<int>(600 / pitch_nm) + 1;
  HeightField f;
  f.z_nm = Grid<double>(n, n);
  f.pitch_x_nm = f.pitch_y_nm = pitch_nm;
  f.origin_x_nm = f.origin_y_nm = -0.5 * (n - 1) * pitch_nm;
  // Steep enough to be rough: slopes to 30 degrees or so.
  const double k = 0.5 / radius_nm / 0.5, a = 1 / (k * k * radius_nm);
  const double wave = k * 2, height = a / 4;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      f.z_nm(x, y) = height * std::sin(wave * f.x_nm(x)) + height * std::sin(wave * 0.9 * f.y_nm(y));
  s.height_field = mc::HeightFieldBody{"waves", f, 0, Edge::mirror};
  return s;
}

mc::Specimen mesh(const std::string& path, double size_nm) {
  mc::Specimen s = flat();
  TriangleMesh m = io::read_mesh(path, 1.0);
  const Box box = bounds(m);
  const Vec3 size = box.size_nm();
  const double scale = size_nm / std::max({size.x, size.y, size.z});
  for (Vec3& v : m.vertices_nm) {
    const Vec3 p = v - box.center_nm();
    v = {p.x * scale, p.y * scale, (v.z - box.lower_nm.z) * scale - 0.05 * size_nm};
  }
  s.bodies.push_back({std::filesystem::path(path).stem().string(), m, 0});
  return s;
}

mc::Scan view(double width_nm, int pixels) {
  mc::Scan scan;
  scan.width = scan.height = pixels;
  scan.pixel_x_nm = scan.pixel_y_nm = width_nm / pixels;
  return scan;
}

mc::Beam beam(double energy_ev) {
  mc::Beam b;
  b.energy_ev = energy_ev;
  return b;
}

json report(const mc::SimulationResult& r) {
  const mc::Balance& b = r.balance;
  const double n = static_cast<double>(std::max<std::int64_t>(b.incident, 1));
  return {{"primaries", b.incident},
          {"seconds", r.seconds},
          {"library_seconds", r.library_seconds},
          {"library_cascades", r.library_cascades},
          {"primaries_per_second", n / r.seconds},
          {"rays_per_primary", static_cast<double>(b.rays) / n},
          {"se_yield", static_cast<double>(b.se) / n},
          {"bse_yield", static_cast<double>(b.bse) / n},
          {"lost", b.total_lost()}};
}

struct Sizes {
  int pixels;
  std::int64_t direct, replay;
};

// Direct and replay side by side on one scene.
json compare(const char* name, const mc::Specimen& specimen, double width_nm, double energy_ev,
             const Sizes& sizes, std::vector<int> threads) {
  const mc::Scene scene(specimen, beam(energy_ev), view(width_nm, sizes.pixels));
  json out{{"scene", name}, {"energy_ev", energy_ev}, {"triangles", scene.summary().triangles},
           {"build_seconds", scene.summary().build_seconds}};
  for (const int t : threads) {
    mc::SimulationOptions o;
    o.threads = t;
    o.electrons = sizes.direct;
    const auto direct = mc::simulate(scene, o);
    o.method = mc::Method::replay;
    o.electrons = sizes.replay;
    const auto replay = mc::simulate(scene, o);
    json row{{"threads", t}, {"direct", report(direct)}, {"replay", report(replay)}};
    row["gain"] = row["replay"]["primaries_per_second"].get<double>() /
                  row["direct"]["primaries_per_second"].get<double>();
    fmt::print(stderr, "{} {} eV, {} threads: direct {:.0f}/s, replay {:.0f}/s\n", name, energy_ev,
               t, row["direct"]["primaries_per_second"].get<double>(),
               row["replay"]["primaries_per_second"].get<double>());
    out["runs"].push_back(std::move(row));
  }
  return out;
}

// An image to an accuracy: time, electrons, and whether every pixel got there.
json to_accuracy(const char* name, const mc::Specimen& specimen, double width_nm, int pixels,
                 double accuracy, double energy_ev, bool control, bool bse) {
  const mc::Scene scene(specimen, beam(energy_ev), view(width_nm, pixels));
  mc::SimulationOptions o;
  o.method = mc::Method::replay;
  o.accuracy = accuracy;
  o.planar_control = control;
  if (!bse) o.detectors.resize(1);
  const auto r = mc::simulate(scene, o);
  double worst = 0;
  std::int64_t over = 0, all = 0;
  for (int y = 0; y < pixels; ++y)
    for (int x = 0; x < pixels; ++x)
      for (std::size_t d = 0; d < o.detectors.size(); ++d) {
        const mc::Estimate e = r.yield(d, x, y);
        const double share = e.standard_error / std::max(accuracy * e.mean, o.accuracy_floor);
        worst = std::max(worst, share);
        over += share > 1;
        ++all;
      }
  json out = report(r);
  out["scene"] = name;
  out["energy_ev"] = energy_ev;
  out["control"] = control;
  out["detectors"] = bse ? "SE and BSE" : "SE";
  out["accuracy"] = accuracy;
  out["electrons_per_pixel"] = static_cast<double>(r.balance.incident) / pixels / pixels;
  out["worst_error_over_target"] = worst;
  out["fraction_over_target"] = static_cast<double>(over) / static_cast<double>(all);
  fmt::print(stderr, "{} to {}: {:.1f} s ({:.1f} s library), {:.0f} electrons per pixel, {:.0f}/s, worst {:.3f}\n",
             name, accuracy, r.seconds, r.library_seconds, out["electrons_per_pixel"].get<double>(),
             out["primaries_per_second"].get<double>(), worst);
  return out;
}

json generation(double energy_ev, int threads) {
  const mc::Material si = io::find_material("Si", "bench");
  mc::CascadeLibrary library({si, {}, energy_ev + si.barrier_ev, 1});
  const auto begin = std::chrono::steady_clock::now();
  library.grow(10000, threads);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const mc::CascadeStatistics s = mc::describe(library, 2048);
  const double per = seconds * 10000 / static_cast<double>(library.cascades());
  fmt::print(stderr, "10,000 cascades at {} eV: {:.3f} s on {} threads, {:.0f} bytes each\n",
             energy_ev, per, threads, s.bytes_per_cascade);
  return {{"energy_ev", energy_ev}, {"threads", threads}, {"seconds_per_10000", per},
          {"bytes_per_cascade", s.bytes_per_cascade}, {"segments", s.segments_per_cascade},
          {"electrons", s.electrons_per_cascade}};
}

}  // namespace

int main(int argc, char** argv) {
  bool quick = false;
  std::string only, file, data;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--quick") == 0) quick = true;
    else if (std::strcmp(argv[i], "--only") == 0 && i + 1 < argc) only = argv[++i];
    else if (std::strcmp(argv[i], "--data") == 0 && i + 1 < argc) data = argv[++i];
    else file = argv[i];
  }
  const auto wanted = [&](const char* what) {
    return only.empty() || std::string(what).find(only) != std::string::npos;
  };
  const int scale = quick ? 4 : 1;
  const Sizes sizes{128, quick ? 1 : 8, 800 / scale};
  json out;
  if (wanted("library"))
    for (const double e : {500.0, 1000.0, 3000.0, 10000.0})
      if (!quick || e <= 1000) out["library"].push_back(generation(e, 2));
  if (wanted("flat")) out["speed"].push_back(compare("flat", flat(), 100, 1000, sizes, {1, 2}));
  if (wanted("mesa")) out["speed"].push_back(compare("mesa", mesa(), 192, 1000, sizes, {1, 2}));
  if (!data.empty())
    for (const char* name : {"bunny", "dragonfly"})
      if (wanted(name))
        for (const auto& entry : std::filesystem::directory_iterator(data))
          if (entry.path().stem().string().starts_with(name)) {
            out["speed"].push_back(compare(name, mesh(entry.path().string(), 300), 330, 1000,
                                           {128, sizes.direct, sizes.replay / 4}, {2}));
            break;
          }
  if (wanted("triangles"))
    for (const double pitch : {2.0, 0.2})
      out["triangles"].push_back(
          compare("mesa", mesa(pitch), 192, 1000, {64, sizes.direct, sizes.replay}, {2}));
  if (wanted("rough"))
    for (const double radius : {250.0, 25.0})
      for (const bool bse : {false, true}) {
        const std::string name = fmt::format("rough, radii from {} nm", radius);
        const int pixels = quick ? 64 : 256;
        out["accuracy"].push_back(to_accuracy(name.c_str(), waves(radius, radius > 100 ? 4 : 1),
                                              2.0 * pixels, pixels, 0.01, 1000, true, bse));
      }
  if (wanted("energies"))
    for (const double e : {500.0, 1000.0, 2000.0, 5000.0, 10000.0})
      for (const double radius : {250.0, 25.0}) {
        const mc::Specimen s = waves(radius, radius > 100 ? 4 : 1);
        const std::string name = fmt::format("waves {} nm", radius);
        json row = compare(name.c_str(), s, 64, e, {32, 4, 100}, {2});
        row["accuracy"] = to_accuracy(name.c_str(), s, 64, 32, 0.03, e, true, true);
        out["energies"].push_back(std::move(row));
      }
  const std::string text = out.dump(2) + "\n";
  if (file.empty()) fmt::print("{}", text);
  else std::ofstream(file) << text;
}
