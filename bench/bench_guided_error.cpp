// SPDX-License-Identifier: GPL-3.0-or-later
// The true error of a guided image of samples/rough.toml, 256 x 256 pixels, far below the noise of
// any reference:
//   bench_guided_error SCENE.toml FOLDER IMAGE.exr ...
// Two independent references of 1000 electrons per pixel and 600,000 cascades (eight minutes and 9
// GB each, two threads) are made in FOLDER where they are missing. The mean product of an image's
// differences to both is its mean square error, without knowing the noise of either; common to both
// is only the image's own. Relative to the mean of the references over two pixels.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "surf/io/image_file.h"
#include "surf/io/sim/scene_file.h"
#include "surf/sem/guided_estimate.h"
#include "surf/workflow/simulate_job.h"

namespace {

using namespace surf;

constexpr int size_px = 256;
constexpr double around_px = 2, darkest = 0.05;  // of the mean

Image reference(const std::filesystem::path& scene, const std::filesystem::path& file,
                std::uint64_t seed) {
  if (std::filesystem::exists(file)) return io::read_image(file);
  workflow::SimulateJob job;
  job.scene = io::read_scene(scene);
  job.scene.scan.width = job.scene.scan.height = size_px;
  job.scene.budget = mc::ElectronsPerPixel{1000};
  job.scene.seed = seed;
  const auto simulator = [](const mc::Scene& s, const mc::SimulationOptions& o,
                            const mc::SimulationContext& c) {
    mc::SimulationOptions more = o;
    more.least_cascades = 600'000;
    return mc::simulate(s, more, c);
  };
  const auto done = workflow::run(std::move(job), {}, nullptr, simulator);
  io::write_image(file, workflow::image_of(done), {});
  return io::read_image(file);
}

void compare(const Image& a, const Image& b, const Image& image, const char* detector) {
  const auto &x = a.find(detector)->values, &y = b.find(detector)->values,
             &seen = image.find(detector)->values,
             &stated = image.find(std::string(detector) + ".stderr")->values;
  Grid<double> level(x.width(), x.height());
  const Grid<double> ones(x.width(), x.height(), 1.0);
  const auto n = static_cast<double>(x.size());
  double mean = 0, square = 0, fourth = 0, stated2 = 0, off = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    level.data()[k] = 0.5 * (x.data()[k] + y.data()[k]);
    mean += level.data()[k] / n;
  }
  level = mean_around(level, ones, around_px);
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double relative = 1 / std::max(level.data()[k], darkest * mean),
                 p = (seen.data()[k] - x.data()[k]) * relative,
                 q = (seen.data()[k] - y.data()[k]) * relative;
    square += p * q / n, fourth += p * q * p * q / n, off += 0.5 * (p + q) / n;
    stated2 += std::pow(stated.data()[k] * relative, 2) / n;
  }
  const double error = std::sqrt((fourth - square * square) / n);
  fmt::print(
      "  {:4} mean square error {:.2f} +- {:.2f} %^2, rms {:.2f} %, stated {:.2f} %; mean {:+.2f} "
      "%\n",
      detector, 1e4 * square, 1e4 * error, 100 * std::sqrt(std::max(square, 0.0)),
      100 * std::sqrt(stated2), 100 * off);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    fmt::print(stderr, "bench_guided_error SCENE.toml FOLDER IMAGE.exr ...\n");
    return 2;
  }
  const std::filesystem::path folder = argv[2];
  std::filesystem::create_directories(folder);
  const Image first = reference(argv[1], folder / "first.exr", 9001),
              second = reference(argv[1], folder / "second.exr", 9002);
  for (int i = 3; i < argc; ++i) {
    fmt::print("{}\n", argv[i]);
    const Image image = io::read_image(argv[i]);
    for (const char* detector : {"SE", "BSE"}) compare(first, second, image, detector);
  }
}
