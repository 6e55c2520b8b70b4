// SPDX-License-Identifier: GPL-3.0-or-later
// How fast replay is beside direct simulation, as JSON: primaries per second on flat silicon, the
// thesis's mesa and closed meshes; cost against the number of triangles; time of an image of a
// rough surface to 1 %; error at equal time against energy, as a chart, too; what the choice of a
// method goes by. Errors are standard errors per pixel, root mean square over pixels, relative to
// the image's mean. Times `sqrt(seconds)` they no longer depend on how many primaries were spent;
// the square of the ratio of two such numbers, the gain, is how many times less time one takes for
// the same error. Both are without and with the seconds that the library takes, which an image of
// any size pays for once.
//   bench_replay [--quick] [--only WORD] [--data FOLDER] [--chart FILE.png] [output.json]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "scenes.h"
#include "surf/io/mesh_file.h"
#include "surf/io/plot.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/cascades/cascade_library.h"
#include "surf/mc/cascades/library_source.h"
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
  TriangleMesh m = io::read_mesh(path, {1.0, true});
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

// Keeps libraries, and how long they took to make: who gets one again has that to pay, too.
class KeptLibraries : public mc::LibrarySource {
 public:
  std::shared_ptr<const mc::CascadeLibrary> library(const mc::CascadeSettings& settings,
                                                    std::size_t cascades, int threads,
                                                    const Watch& watch) override {
    Kept& kept = kept_[{settings.start_energy_ev, cascades}];
    saved_ += kept.seconds;
    if (kept.library) return kept.library;
    const auto begin = std::chrono::steady_clock::now();
    kept.library = fresh_.library(settings, cascades, threads, watch);
    kept.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return kept.library;
  }

  /// What those got since the last call would have taken; 0 for those that were made.
  double take_saved_seconds() { return std::exchange(saved_, 0.0); }

  void clear() {
    kept_.clear();
    fresh_ = {};
  }

 private:
  struct Kept {
    std::shared_ptr<const mc::CascadeLibrary> library;
    double seconds = 0;
  };
  mc::FreshLibraries fresh_;
  std::map<std::pair<double, std::size_t>, Kept> kept_;
  double saved_ = 0;
};

// Relative to the mean of all pixels.
double error_of(const mc::SimulationResult& r, std::size_t detector) {
  double mean = 0, squares = 0;
  for (int y = 0; y < r.pixels.height(); ++y)
    for (int x = 0; x < r.pixels.width(); ++x) {
      const mc::Estimate e = r.yield(detector, x, y);
      mean += e.mean;
      squares += e.standard_error * e.standard_error;
    }
  const double pixels = static_cast<double>(r.pixels.width()) * r.pixels.height();
  return mean > 0 ? std::sqrt(squares * pixels) / mean : 0;
}

// `saved_seconds`: what the library would have taken in addition.
json report(const mc::SimulationResult& r, double saved_seconds = 0) {
  const mc::Balance& b = r.balance;
  const double n = static_cast<double>(std::max<std::int64_t>(b.incident, 1));
  const double library_seconds = r.library_seconds + saved_seconds;
  json out{{"primaries", b.incident},
           {"seconds", r.seconds},
           {"library_seconds", library_seconds},
           {"library_cascades", r.library_cascades},
           {"primaries_per_second", n / r.seconds},
           {"rays_per_primary", static_cast<double>(b.rays) / n},
           {"se_yield", static_cast<double>(b.se) / n},
           {"bse_yield", static_cast<double>(b.bse) / n},
           {"lost", b.total_lost()}};
  for (std::size_t d = 0; d < r.detectors.size(); ++d) {
    const double error = error_of(r, d);
    out["errors"][r.detectors[d].name] = {
        {"error", error},
        {"root_seconds", error * std::sqrt(r.seconds)},
        {"root_seconds_with_library", error * std::sqrt(r.seconds + library_seconds)}};
  }
  return out;
}

// Of two reports, per detector: errors at equal time, the first's over the second's, and the gain.
json at_equal_time(const json& direct, const json& replay) {
  json out;
  for (const auto& [detector, of_direct] : direct["errors"].items()) {
    const json& of_replay = replay["errors"][detector];
    const auto ratio = [&](const char* key) {
      return of_direct["root_seconds"].get<double>() / of_replay[key].get<double>();
    };
    const double alone = ratio("root_seconds"), all = ratio("root_seconds_with_library");
    out[detector] = {{"error_ratio", alone},
                     {"gain", alone * alone},
                     {"error_ratio_with_library", all},
                     {"gain_with_library", all * all}};
  }
  return out;
}

// Primaries per pixel.
struct Sizes {
  std::int64_t direct, replay;
};

// Square, about the origin.
mc::Scene scene_of(const mc::Specimen& specimen, double width_nm, int pixels, double energy_ev) {
  return mc::Scene(specimen, beam(energy_ev), view(width_nm, pixels));
}

// Direct and replay side by side on one scene.
json compare(const char* name, const mc::Scene& scene, const Sizes& sizes, std::vector<int> threads,
             KeptLibraries* kept = nullptr) {
  const double energy_ev = scene.beam().energy_ev;
  json out{{"scene", name},
           {"energy_ev", energy_ev},
           {"triangles", scene.summary().triangles},
           {"build_seconds", scene.summary().build_seconds}};
  for (const int t : threads) {
    mc::SimulationOptions o;
    o.threads = t;
    o.budget = mc::ElectronsPerPixel{sizes.direct};
    const auto direct = mc::simulate(scene, o);
    o.method = mc::Method::replay;
    o.budget = mc::ElectronsPerPixel{sizes.replay};
    const auto replay = mc::simulate(scene, o, {.libraries = kept});
    json row{{"threads", t},
             {"direct", report(direct)},
             {"replay", report(replay, kept ? kept->take_saved_seconds() : 0)}};
    row["equal_time"] = at_equal_time(row["direct"], row["replay"]);
    row["gain"] = row["replay"]["primaries_per_second"].get<double>() /
                  row["direct"]["primaries_per_second"].get<double>();
    fmt::print(
        stderr,
        "{} {} eV, {} threads: direct {:.0f}/s, replay {:.0f}/s, for the same error SE {:.1f}, "
        "BSE {:.1f} times less time\n",
        name, energy_ev, t, row["direct"]["primaries_per_second"].get<double>(),
        row["replay"]["primaries_per_second"].get<double>(),
        row["equal_time"]["SE"]["gain"].get<double>(),
        row["equal_time"]["BSE"]["gain"].get<double>());
    out["runs"].push_back(std::move(row));
  }
  return out;
}

// An image to an accuracy: time, electrons, and whether every pixel got there.
json to_accuracy(const char* name, const mc::Scene& scene, double accuracy, bool control, bool bse,
                 int threads = 0, KeptLibraries* kept = nullptr) {
  const int pixels = scene.scan().width;
  mc::SimulationOptions o;
  o.method = mc::Method::replay;
  o.budget = mc::Accuracy{accuracy};
  o.planar_control = control;
  o.threads = threads;
  if (!bse) o.detectors.resize(1);
  const auto r = mc::simulate(scene, o, {.libraries = kept});
  double worst = 0;
  std::int64_t over = 0, all = 0;
  for (int y = 0; y < pixels; ++y)
    for (int x = 0; x < pixels; ++x)
      for (std::size_t d = 0; d < o.detectors.size(); ++d) {
        const mc::Estimate e = r.yield(d, x, y);
        const double share = e.standard_error / std::max(accuracy * e.mean, mc::floor_of(o.budget));
        worst = std::max(worst, share);
        over += share > 1;
        ++all;
      }
  json out = report(r, kept ? kept->take_saved_seconds() : 0);
  out["scene"] = name;
  out["energy_ev"] = scene.beam().energy_ev;
  out["control"] = control;
  out["detectors"] = bse ? "SE and BSE" : "SE";
  out["accuracy"] = accuracy;
  out["electrons_per_pixel"] = static_cast<double>(r.balance.incident) / pixels / pixels;
  out["worst_error_over_target"] = worst;
  out["fraction_over_target"] = static_cast<double>(over) / static_cast<double>(all);
  fmt::print(
      stderr,
      "{} to {}: {:.1f} s ({:.1f} s library), {:.0f} electrons per pixel, {:.0f}/s, worst {:.3f}\n",
      name, accuracy, r.seconds, out["library_seconds"].get<double>(),
      out["electrons_per_pixel"].get<double>(), out["primaries_per_second"].get<double>(), worst);
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
  return {{"energy_ev", energy_ev},
          {"threads", threads},
          {"seconds_per_10000", per},
          {"bytes_per_cascade", s.bytes_per_cascade},
          {"segments", s.segments_per_cascade},
          {"electrons", s.electrons_per_cascade}};
}

// CPU time of this process, so far: other programs do not count.
double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// One library, whatever is asked for.
class Only : public mc::LibrarySource {
 public:
  explicit Only(std::shared_ptr<const mc::CascadeLibrary> library) : library_(std::move(library)) {}
  std::shared_ptr<const mc::CascadeLibrary> library(const mc::CascadeSettings&, std::size_t, int,
                                                    const Watch&) override {
    return library_;
  }

 private:
  std::shared_ptr<const mc::CascadeLibrary> library_;
};

// What the choice of a method goes by, on one thread: a segment of a cascade that is made, in steps
// of direct simulation; and the share of a primary's time that replay saves.
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
  for (const auto& [name, specimen] : {std::pair("flat", flat()), std::pair("mesa", mesa()),
                                       std::pair("waves 25 nm", waves(25))}) {
    constexpr int pixels = 32;
    const mc::Scene scene(specimen, beam(energy_ev), view(192, pixels));
    mc::SimulationOptions o;
    o.threads = 1;
    o.budget =
        mc::ElectronsPerPixel{static_cast<std::int64_t>(std::clamp(2e4 / energy_ev, 1.0, 20.0))};
    begin = cpu_seconds();
    const mc::Balance b = mc::simulate(scene, o).balance;
    const double direct = cpu_seconds() - begin;
    const double per_step = direct / static_cast<double>(b.steps);
    o.method = mc::Method::replay;
    const double share = mc::mean_electrons_of(o.budget);
    o.budget = mc::ElectronsPerPixel{20};
    begin = cpu_seconds();
    mc::simulate(scene, o, {.libraries = &source});
    const double replay = (cpu_seconds() - begin) * share / mc::mean_electrons_of(o.budget);
    const double making = made / segments / per_step, saved = 1 - replay / direct;
    out["scenes"].push_back({{"scene", name},
                             {"nanoseconds_per_step", 1e9 * per_step},
                             {"making", making},
                             {"saved", saved}});
    fmt::print(stderr, "{} eV, {}: {:.0f} ns per step, making {:.2f}, saved {:.2f}\n", energy_ev,
               name, 1e9 * per_step, making, saved);
  }
  return out;
}

// Waves at one energy: direct simulation, replay, and replay to an accuracy with the planar
// control.
struct EnergyRow {
  double energy_ev, accuracy;
  int pixels;  // across
  Sizes sizes;
};

std::vector<EnergyRow> energy_rows(bool quick) {
  if (quick)
    return {{500, 0.1, 16, {20, 100}}, {1000, 0.1, 16, {20, 100}}, {2000, 0.1, 16, {20, 100}}};
  return {{500, 0.1, 32, {40, 100}},
          {1000, 0.1, 32, {40, 100}},
          {2000, 0.1, 32, {40, 100}},
          {5000, 0.15, 24, {8, 100}},
          {10000, 0.15, 24, {8, 100}}};
}

json at_energy(double radius_nm, const EnergyRow& e, KeptLibraries& kept) {
  constexpr int threads = 1;  // an image of a single tile has work for one
  const mc::Scene scene = scene_of(waves(radius_nm), 64, e.pixels, e.energy_ev);
  const std::string name = fmt::format("waves {} nm", radius_nm);
  json row = compare(name.c_str(), scene, e.sizes, {threads}, &kept);
  row["radius_nm"] = radius_nm;
  json& accuracy = row["accuracy"];
  accuracy = to_accuracy(name.c_str(), scene, e.accuracy, true, true, threads, &kept);
  accuracy["equal_time"] = at_equal_time(row["runs"][0]["direct"], accuracy);
  return row;
}

// Rows by energy, of one radius.
io::PlotPanel panel_of(const json& rows, double radius_nm, bool with_library) {
  const std::string key = with_library ? "gain_with_library" : "gain";
  io::PlotPanel panel;
  panel.title = fmt::format("radii from {} nm, {}", radius_nm,
                            with_library ? "library made for this image" : "library at hand");
  panel.x = {"beam energy (eV)", true, {}};
  panel.y = {"times less time than direct", true, {}};
  panel.references.push_back({io::PlotDirection::horizontal, 1, ""});
  for (const bool control : {false, true})
    for (const char* detector : {"SE", "BSE"}) {
      io::PlotSeries series;
      series.name = fmt::format("{}, {}", detector, control ? "planar control" : "replay alone");
      for (const json& row : rows) {
        if (row["radius_nm"] != radius_nm) continue;
        const json& from = control ? row["accuracy"] : row["runs"][0];
        series.x.push_back(row["energy_ev"]);
        series.y.push_back(from["equal_time"][detector][key]);
      }
      series.style = io::PlotStyle::line_points;
      series.dashed = !control;
      series.color = std::strcmp(detector, "SE") == 0 ? 0 : 1;
      panel.series.push_back(std::move(series));
    }
  return panel;
}

io::Plot chart_of(const json& rows) {
  io::Plot plot;
  plot.title = "Replay: time for the same standard error per pixel, silicon, one thread";
  plot.columns = 2;
  for (const bool with_library : {false, true})
    for (const double radius_nm : {250.0, 25.0})
      plot.panels.push_back(panel_of(rows, radius_nm, with_library));
  return plot;
}

}  // namespace

int main(int argc, char** argv) {
  bool quick = false;
  std::string only, file, data, chart;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--quick") == 0) quick = true;
    else if (std::strcmp(argv[i], "--only") == 0 && i + 1 < argc) only = argv[++i];
    else if (std::strcmp(argv[i], "--data") == 0 && i + 1 < argc) data = argv[++i];
    else if (std::strcmp(argv[i], "--chart") == 0 && i + 1 < argc) chart = argv[++i];
    else file = argv[i];
  }
  const auto wanted = [&](const char* what) {
    return only.empty() || std::string(what).find(only) != std::string::npos;
  };
  if (!chart.empty() && !wanted("energies")) {
    fmt::print(stderr, "--chart draws the energies: leave --only out, or say --only energies\n");
    return 2;
  }
  if (!chart.empty()) io::check_plot_target(chart);
  const int scale = quick ? 4 : 1;
  const Sizes sizes{quick ? 2 : 8, 800 / scale};
  json out;
  if (wanted("library"))
    for (const double e : {500.0, 1000.0, 3000.0, 10000.0})
      if (!quick || e <= 1000) out["library"].push_back(generation(e, 2));
  if (wanted("choice"))
    for (const double e : {500.0, 1000.0, 3000.0, 10000.0, 30000.0})
      if (!quick || e <= 3000) out["choice"].push_back(choice(e));
  if (wanted("flat"))
    out["speed"].push_back(compare("flat", scene_of(flat(), 100, 128, 1000), sizes, {1, 2}));
  if (wanted("mesa"))
    out["speed"].push_back(compare("mesa", scene_of(mesa(), 192, 128, 1000), sizes, {1, 2}));
  if (!data.empty())
    for (const char* name : {"bunny", "dragonfly"})
      if (wanted(name))
        for (const auto& entry : std::filesystem::directory_iterator(data))
          if (entry.path().stem().string().starts_with(name)) {
            const mc::Scene scene = scene_of(mesh(entry.path().string(), 300), 330, 128, 1000);
            out["speed"].push_back(compare(name, scene, {sizes.direct, sizes.replay / 4}, {2}));
            break;
          }
  if (wanted("triangles"))
    for (const double pitch : {2.0, 0.2})
      out["triangles"].push_back(compare("mesa", scene_of(mesa(pitch), 192, 64, 1000), sizes, {2}));
  if (wanted("rough"))
    for (const double radius : {250.0, 25.0})
      for (const bool bse : {false, true}) {
        const std::string name = fmt::format("rough, radii from {} nm", radius);
        const int pixels = quick ? 64 : 256;
        const mc::Scene scene = scene_of(waves(radius), 2.0 * pixels, pixels, 1000);
        out["accuracy"].push_back(to_accuracy(name.c_str(), scene, 0.01, true, bse));
      }
  if (wanted("energies")) {
    KeptLibraries kept;
    for (const EnergyRow& row : energy_rows(quick)) {
      for (const double radius_nm : {250.0, 25.0})
        out["energies"].push_back(at_energy(radius_nm, row, kept));
      kept.clear();  // those of high energies are large
    }
  }
  const std::string text = out.dump(2) + "\n";
  if (file.empty()) fmt::print("{}", text);
  else std::ofstream(file) << text;
  if (!chart.empty()) io::write_plot(chart, chart_of(out["energies"]));
}
