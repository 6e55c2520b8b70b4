// SPDX-License-Identifier: GPL-3.0-or-later
// How fast replay is beside direct simulation, as JSON: primaries per second on flat silicon, the
// thesis's mesa and closed meshes; cost against the number of triangles; time of an image of a rough
// surface to 1 %; error at equal time against energy; what the choice of a method goes by.
//   bench_replay [--quick] [--only WORD] [--data FOLDER] [output.json]
#include <algorithm>
#include <chrono>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "scenes.h"
#include "surf/io/mesh_file.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/cascade_library.h"
#include "surf/mc/library_source.h"
#include "surf/mc/simulate.h"

namespace {

using namespace surf;
using bench::beam;
using bench::view;
using nlohmann::json;

mc::Specimen flat() { return bench::flat(bench::only_silicon()); }
mc::Specimen mesa(double pitch_nm = 2) { return bench::mesa(bench::only_silicon(), pitch_nm); }

// Gentle waves whose smallest radius of curvature is 250 nm, or 25 nm.
mc::Specimen waves(double radius_nm) {
  const bool long_ones = radius_nm > 100;
  return bench::waves(bench::only_silicon(), long_ones ? 200 : 60, radius_nm, long_ones ? 4 : 1);
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

// CPU time of this process, so far: other programs do not count.
double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// One library, whatever is asked for.
class Only : public mc::LibrarySource {
 public:
  explicit Only(std::shared_ptr<const mc::CascadeLibrary> library) : library_(std::move(library)) {}
  std::shared_ptr<const mc::CascadeLibrary> library(const mc::CascadeSettings&, std::size_t, int,
                                                    const ProgressCallback&,
                                                    const CancelToken*) override {
    return library_;
  }

 private:
  std::shared_ptr<const mc::CascadeLibrary> library_;
};

// What the choice of a method goes by, on one thread: a segment of a cascade that is made, in steps of
// direct simulation; and the share of a primary's time that replay saves.
json choice(double energy_ev) {
  const mc::Material si = io::find_material("Si", "bench");
  auto library = std::make_shared<mc::CascadeLibrary>(
      mc::CascadeSettings{si, {}, energy_ev + si.barrier_ev, 1});
  double begin = cpu_seconds();
  library->grow(1, 1);
  const double made = cpu_seconds() - begin;
  const double segments = mc::describe(*library, library->cascades()).segments_per_cascade *
                          static_cast<double>(library->cascades());
  Only source(library);
  json out{{"energy_ev", energy_ev}, {"nanoseconds_per_segment_made", 1e9 * made / segments}};
  for (const auto& [name, specimen] :
       {std::pair("flat", flat()), std::pair("mesa", mesa()), std::pair("waves 25 nm", waves(25))}) {
    constexpr int pixels = 32;
    const mc::Scene scene(specimen, beam(energy_ev), view(192, pixels));
    mc::SimulationOptions o;
    o.threads = 1;
    o.electrons = static_cast<std::int64_t>(std::clamp(2e4 / energy_ev, 1.0, 20.0));
    begin = cpu_seconds();
    const mc::Balance b = mc::simulate(scene, o).balance;
    const double direct = cpu_seconds() - begin;
    const double per_step = direct / static_cast<double>(b.steps);
    o.method = mc::Method::replay;
    const double share = static_cast<double>(o.electrons);
    o.electrons = 20;
    begin = cpu_seconds();
    mc::simulate(scene, o, {}, nullptr, {}, nullptr, &source);
    const double replay = (cpu_seconds() - begin) * share / static_cast<double>(o.electrons);
    const double making = made / segments / per_step, saved = 1 - replay / direct;
    out["scenes"].push_back({{"scene", name}, {"nanoseconds_per_step", 1e9 * per_step},
                             {"making", making}, {"saved", saved}});
    fmt::print(stderr, "{} eV, {}: {:.0f} ns per step, making {:.2f}, saved {:.2f}\n", energy_ev, name,
               1e9 * per_step, making, saved);
  }
  return out;
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
  if (wanted("choice"))
    for (const double e : {500.0, 1000.0, 3000.0, 10000.0, 30000.0})
      if (!quick || e <= 3000) out["choice"].push_back(choice(e));
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
        out["accuracy"].push_back(to_accuracy(name.c_str(), waves(radius),
                                              2.0 * pixels, pixels, 0.01, 1000, true, bse));
      }
  if (wanted("energies"))
    for (const double e : {500.0, 1000.0, 2000.0, 5000.0, 10000.0})
      for (const double radius : {250.0, 25.0}) {
        const mc::Specimen s = waves(radius);
        const std::string name = fmt::format("waves {} nm", radius);
        json row = compare(name.c_str(), s, 64, e, {32, 4, 100}, {2});
        row["accuracy"] = to_accuracy(name.c_str(), s, 64, 32, 0.03, e, true, true);
        out["energies"].push_back(std::move(row));
      }
  const std::string text = out.dump(2) + "\n";
  if (file.empty()) fmt::print("{}", text);
  else std::ofstream(file) << text;
}
