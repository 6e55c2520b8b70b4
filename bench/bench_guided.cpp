// SPDX-License-Identifier: GPL-3.0-or-later
// Guided images against plain ones, and the errors that they state against those that they have.
//   bench_guided FOLDER SCENES [ELECTRONS] [SEEDS] [NAME ...]
// The scene "bunny" is there where SEMSURF_TEST_DATA has its mesh.
// SCENES is bench/guided. Scenes called rough, mesa, trench and sphere chose the method; the others
// judge it. Each is guided by shape, silicon also by samples/si-1keV-3nm.json beside SCENES; the
// scene "gold" is guided by that model, too, which is wrong there. References of 1500 electrons per
// pixel from libraries of 120,000 cascades of another seed are kept in FOLDER; what their own noise
// adds is taken out. Columns, for each detector and region (flat: where the reference changes
// least, edge: most, dark: the darkest fifth):
//   plain, guided   rms of the error over the yield around, %
//   worth           how many times the electrons plain images take for the guided error
//   ratio           rms of the error over that which is stated
//   z               rms of the ratio of the two, pixel by pixel
//   1s, 2s          % of pixels within one and two stated errors (68 and 95 would be right)
//   95 %, max       of |error| over the yield around, %, the reference's noise included
// The last rows pool the scenes that judge: each of their seeds has a library of its own.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "surf/io/cache.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"
#include "surf/io/sim/scene_file.h"
#include "surf/sem/guided_estimate.h"
#include "surf/workflow/simulate_job.h"

namespace {

using namespace surf;
namespace fs = std::filesystem;

constexpr std::size_t reference_cascades = 120'000;
constexpr std::int64_t reference_electrons = 1500;
constexpr std::uint64_t reference_seed = 9001;

workflow::SimulateJob job_of(const fs::path& scene, std::int64_t electrons, std::uint64_t seed) {
  workflow::SimulateJob job;
  job.scene = io::read_scene(scene);
  job.scene.budget = mc::ElectronsPerPixel{electrons};
  job.scene.seed = seed;
  job.cache = io::cache_folder();
  return job;
}

// Yield and variance of each detector, the library's share included.
Image reference(const fs::path& folder, const fs::path& scene) {
  const fs::path file = folder / (scene.stem().string() + "-reference.exr");
  if (fs::exists(file)) return io::read_image(file);
  workflow::SimulateJob job = job_of(scene, reference_electrons, reference_seed);
  const auto simulator = [](const mc::Scene& s, const mc::SimulationOptions& options,
                            const mc::SimulationContext& context) {
    mc::SimulationOptions more = options;
    more.least_cascades = reference_cascades;
    return mc::simulate(s, more, context);
  };
  const workflow::SimulateSummary done = workflow::run(std::move(job), {}, nullptr, simulator);
  Image image = workflow::image_of(done);
  const double share =
      done.result.library_cascades > 0
          ? std::sqrt(1 + double(reference_electrons) / double(done.result.library_cascades))
          : 1;
  for (Channel& c : image.channels)
    if (c.name.ends_with(".stderr"))
      for (float& value : c.values.data()) value *= static_cast<float>(share);
  io::write_image(file, image, {});
  return image;
}

const Grid<float>& channel(const Image& image, const std::string& name) {
  return std::ranges::find(image.channels, name, &Channel::name)->values;
}

struct Sums {
  double pixels = 0, plain = 0, guided = 0, stated = 0, within_1 = 0, within_2 = 0, doubtful = 0,
         z = 0;
  std::vector<double> errors;
};

// In which regions a pixel is.
std::vector<std::vector<std::string>> regions_of(const Grid<double>& yield) {
  const int width = yield.width(), height = yield.height();
  std::vector<double> slope(yield.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto at = [&](int u, int v) {
        return std::log(
            std::max(yield(std::clamp(u, 0, width - 1), std::clamp(v, 0, height - 1)), 1e-4));
      };
      slope[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
            static_cast<std::size_t>(x)] =
          std::hypot(at(x + 1, y) - at(x - 1, y), at(x, y + 1) - at(x, y - 1));
    }
  const auto quantile = [](std::vector<double> values, double share) {
    std::ranges::sort(values);
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  const double flat = quantile(slope, 0.4), edge = quantile(slope, 0.9),
               dark = quantile(yield.data(), 0.2);
  std::vector<std::vector<std::string>> regions(yield.size());
  for (std::size_t i = 0; i < yield.size(); ++i) {
    regions[i].push_back("all");
    if (slope[i] <= flat) regions[i].push_back("flat");
    if (slope[i] >= edge) regions[i].push_back("edge");
    if (yield.data()[i] <= dark) regions[i].push_back("dark");
  }
  return regions;
}

using Table = std::map<std::string, std::map<std::string, Sums>>;  // by detector and region

void print(Table& table) {
  for (auto& [detector, by_region] : table)
    for (const char* region : {"all", "flat", "edge", "dark"}) {
      Sums& s = by_region[region];
      std::ranges::sort(s.errors);
      const auto percent = [&](double square) {
        return 100 * std::sqrt(std::max(0.0, square) / s.pixels);
      };
      fmt::print(
          "  {:4} {:5} plain {:5.1f} guided {:5.2f} worth {:6.1f} ratio {:5.2f} z {:5.2f} 1s "
          "{:5.1f} "
          "2s {:5.1f} 95 % {:5.1f} max {:5.1f} (reference {:.2f})\n",
          detector, region, percent(s.plain), percent(s.guided), s.plain / s.guided,
          std::sqrt(std::max(0.0, s.guided) / s.stated), std::sqrt(std::max(0.0, s.z) / s.pixels),
          100 * s.within_1 / s.pixels, 100 * s.within_2 / s.pixels,
          100 * s.errors[static_cast<std::size_t>(0.95 * (s.pixels - 1))], 100 * s.errors.back(),
          percent(s.doubtful));
    }
  std::fflush(stdout);
}

void add(Table& pooled, const Table& table) {
  for (const auto& [detector, by_region] : table)
    for (const auto& [region, more] : by_region) {
      Sums& s = pooled[detector][region];
      s.pixels += more.pixels;
      s.plain += more.plain;
      s.guided += more.guided;
      s.stated += more.stated;
      s.within_1 += more.within_1;
      s.within_2 += more.within_2;
      s.doubtful += more.doubtful;
      s.z += more.z;
      s.errors.insert(s.errors.end(), more.errors.begin(), more.errors.end());
    }
}

void compare(const fs::path& folder, const fs::path& scenes, const std::string& name,
             const fs::path& model, std::int64_t electrons, int seeds, Table& pooled) {
  const fs::path scene = scenes / (name + ".toml");
  const Image truth = reference(folder, scene);
  Table sums;
  double seconds = 0, simulated = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    workflow::SimulateJob job = job_of(scene, electrons, static_cast<std::uint64_t>(seed));
    job.estimate.kind = workflow::Estimate::guided;
    const bool silicon = job.scene.specimen.materials.size() == 1 &&
                         job.scene.specimen.materials[0].name == "Si" &&
                         job.scene.beam.energy_ev == 1000 && job.scene.beam.tilt_deg == 0;
    job.estimate.model = silicon || name == "gold" ? model.string() : "off";
    const auto begin = std::chrono::steady_clock::now();
    const workflow::SimulateSummary done = workflow::run(std::move(job));
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    simulated += done.result.seconds;
    for (std::size_t d = 0; d < done.result.detectors.size(); ++d) {
      const std::string detector = done.result.detectors[d].name;
      const Grid<float>&yields = channel(truth, detector),
            &noise = channel(truth, detector + ".stderr");
      Grid<double> around(yields.width(), yields.height()),
          ones(yields.width(), yields.height(), 1.0);
      std::ranges::copy(yields.data(), around.data().begin());
      around = mean_around(around, ones, 2);
      const double least = 0.05 * mean_around(around, ones, 1000)(0, 0);
      const auto regions = regions_of(around);
      for (int y = 0; y < yields.height(); ++y)
        for (int x = 0; x < yields.width(); ++x) {
          const double scale = std::max(around(x, y), least),
                       own = std::pow(noise(x, y) / scale, 2),
                       plain = (done.result.yield(d, x, y).mean - yields(x, y)) / scale,
                       guided = (done.guided[d].mean(x, y) - yields(x, y)) / scale,
                       stated = done.guided[d].error(x, y) / scale;
          const double expected = std::sqrt(stated * stated + own);
          for (const std::string& region :
               regions[static_cast<std::size_t>(y) * static_cast<std::size_t>(yields.width()) +
                       static_cast<std::size_t>(x)]) {
            Sums& s = sums[detector][region];
            s.pixels += 1;
            s.plain += plain * plain - own;
            s.guided += guided * guided - own;
            s.stated += stated * stated;
            s.doubtful += own;
            s.z += (guided * guided - own) / (stated * stated);
            s.within_1 += std::abs(guided) <= expected;
            s.within_2 += std::abs(guided) <= 2 * expected;
            s.errors.push_back(std::abs(guided));
          }
        }
    }
  }
  const bool chose = name == "rough" || name == "mesa" || name == "trench" || name == "sphere";
  fmt::print("{} ({}), {} electrons, {} seeds: {:.2f} s each, {:.2f} s of them simulating\n", name,
             chose ? "chose" : "judges", electrons, seeds, seconds / seeds, simulated / seeds);
  print(sums);
  if (!chose) add(pooled, sums);
}

/// A bunny on silicon, whose mesh is not ours: one of the files for tests, where they are.
bool write_bunny(const fs::path& file) {
  const char* const data = std::getenv("SEMSURF_TEST_DATA");
  const fs::path mesh = fs::path(data ? data : "") / "mesh" / "bunny_libigl.off";
  if (!data || !fs::exists(mesh)) return false;
  io::write_text(file, fmt::format(R"(title = "a bunny of silicon on silicon"
[beam]
energy = "1keV"
[scan]
size = "96x96"
region = "-96,-96,96,96"
[substrate]
material = "Si"
[[body]]
material = "Si"
mesh = "{}"
unit = "um"
rotate_x = "90deg"
move = "17,0,-32"
)",
                                   fs::absolute(mesh).string()));
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "bench_guided FOLDER SCENES [ELECTRONS] [SEEDS] [NAME ...]\n");
    return 2;
  }
  const fs::path folder = argv[1], scenes = fs::canonical(argv[2]);
  fs::create_directories(folder);
  const fs::path model = scenes.parent_path().parent_path() / "samples" / "si-1keV-3nm.json";
  const std::int64_t electrons = argc > 3 ? std::atoi(argv[3]) : 64;
  const int seeds = argc > 4 ? std::atoi(argv[4]) : 3;
  std::vector<std::string> names(argv + std::min(argc, 5), argv + argc);
  if (names.empty()) {
    for (const auto& entry : fs::directory_iterator(scenes))
      if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    std::ranges::sort(names);
  }
  Table pooled;
  for (const std::string& name : names)
    if (name != "bunny") compare(folder, scenes, name, model, electrons, seeds, pooled);
  if (argc <= 5 || std::ranges::count(names, "bunny") > 0) {
    if (write_bunny(folder / "bunny.toml"))
      compare(folder, folder, "bunny", model, electrons, seeds, pooled);
    else fmt::print("bunny: left out, as SEMSURF_TEST_DATA has no mesh/bunny_libigl.off\n");
  }
  fmt::print("all that judge\n");
  print(pooled);
}
