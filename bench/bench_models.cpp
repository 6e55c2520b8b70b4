// SPDX-License-Identifier: GPL-3.0-or-later
// How far fast image models are from Monte Carlo on surfaces that they were not trained on, against
// the time that they take: the thesis's table 6-2 and figures 6-9, 6-10, E-3 and E-4, and a chart
// of error against time.
//   bench_models FOLDER MODEL.json ...
// Models as `semsurf train` writes them, of silicon at 1 keV. Surfaces: after the thesis's
// description a square 20 nm high, 45 nm wide at the top with 3 nm pixels, or 15 nm with 1 nm
// pixels, its walls 6 nm long; and bumps and crevices like its figure 6-4. A model sees those of
// its own pixel size. The Monte Carlo images are kept in FOLDER and made where they are not there:
// two independent halves, each of several libraries of cascades. Of squares the eight mirror images
// and turns are averaged. What is written beside them: models.csv, models.svg and, for each
// surface, a picture NAME.png: above SE, below BSE, Monte Carlo first, then the models in their
// order. rms: of the difference to the truth, from the product of the differences to both halves,
// whose noise is independent. mean, median, deviation and maximum are of |model - image| / image as
// the thesis has them, the image's noise included; mean less noise takes the noise's share off a
// folded normal distribution.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "surf/core/random.h"
#include "surf/io/image_file.h"
#include "surf/io/model/model_file.h"
#include "surf/io/plot.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/simulate.h"
#include "surf/mesh/shapes.h"

namespace {

using namespace surf;
namespace fs = std::filesystem;

constexpr int libraries = 4;  // of each half

struct Surface {
  std::string name;
  double pixel_nm;
  HeightField field;
  bool square;             ///< it has the symmetry of one
  std::int64_t electrons;  ///< per pixel and library
};

HeightField square(int pixels, double pixel_nm, double top_nm) {
  const double across = (pixels - 1) * pixel_nm;
  return make_mesa({across, across, pixel_nm}, 20, top_nm, 6);
}

/// Half-buried balls on self-affine ground: what figure 6-4 shows.
HeightField crevices(int pixels, double pixel_nm, std::uint64_t seed) {
  const double across = (pixels - 1) * pixel_nm;
  HeightField field = make_self_affine({across, across, pixel_nm}, 7, 45, 0.9, seed);
  RandomStream random(seed, 7, 7);
  const HeightField ground = field;
  const int balls = static_cast<int>(30 * std::pow(across / 300, 2)) + 3;
  for (int i = 0; i < balls; ++i) {
    const double x = (random.uniform() - 0.5) * across, y = (random.uniform() - 0.5) * across;
    const double radius = 8 + 22 * random.uniform(), rise = 0.2 + 0.7 * random.uniform();
    const int cx = std::clamp(static_cast<int>((x - field.origin_x_nm) / pixel_nm), 0, pixels - 1);
    const int cy = std::clamp(static_cast<int>((y - field.origin_y_nm) / pixel_nm), 0, pixels - 1);
    const double base = 0.6 * ground.z_nm(cx, cy) - 2;
    for (int v = 0; v < pixels; ++v)
      for (int u = 0; u < pixels; ++u) {
        const double d2 = std::pow(field.x_nm(u) - x, 2) + std::pow(field.y_nm(v) - y, 2);
        if (d2 < radius * radius)
          field.z_nm(u, v) =
              std::max(field.z_nm(u, v), base + rise * std::sqrt(radius * radius - d2));
      }
  }
  return field;
}

std::vector<Surface> surfaces() {
  return {{"square-45nm-3nm", 3, square(64, 3, 45), true, 400},
          {"square-15nm-1nm", 1, square(64, 1, 15), true, 400},
          {"crevices-3nm", 3, crevices(100, 3, 11), false, 250},
          {"crevices-1nm", 1, crevices(100, 1, 12), false, 250}};
}

Grid<double> symmetric(const Grid<double>& image) {
  const int n = image.width();
  Grid<double> out(n, n);
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      for (const int u : {x, n - 1 - x})
        for (const int v : {y, n - 1 - y}) out(x, y) += (image(u, v) + image(v, u)) / 8;
  return out;
}

/// Half `half` of the Monte Carlo images: SE and BSE.
std::vector<Grid<double>> reference(const Surface& surface, int half, const fs::path& folder) {
  const int width = surface.field.z_nm.width(), height = surface.field.z_nm.height();
  std::vector<Grid<double>> sum(2, Grid<double>(width, height));
  for (int library = 0; library < libraries; ++library) {
    const fs::path path = folder / fmt::format("{}.{}{}.exr", surface.name, "ab"[half], library);
    if (!fs::exists(path)) {
      fmt::print(stderr, "simulating {}\n", path.filename().string());
      mc::Specimen specimen;
      specimen.materials = {io::find_material("Si", "bench")};
      specimen.height_field = mc::HeightFieldBody{surface.name, surface.field, 0, Edge::mirror};
      mc::Scan scan;
      scan.width = width;
      scan.height = height;
      scan.pixel_x_nm = scan.pixel_y_nm = surface.pixel_nm;
      mc::SimulationOptions options;
      options.method = mc::Method::replay;
      options.budget = mc::ElectronsPerPixel{surface.electrons};
      options.seed = 1000 + 100 * half + library;
      const mc::Scene scene(specimen, mc::Beam{}, scan, mc::Physics{});
      io::write_image(path, mc::make_image(mc::simulate(scene, options), scan));
    }
    const Image image = io::read_image(path);
    const char* const names[] = {"SE", "BSE"};
    for (int c = 0; c < 2; ++c)
      for (std::size_t i = 0; i < sum[c].size(); ++i)
        sum[c].data()[i] += image.find(names[c])->values.data()[i] / double(libraries);
  }
  if (surface.square)
    for (Grid<double>& image : sum) image = symmetric(image);
  return sum;
}

struct Errors {
  double rms, mean, mean_less_noise, median, deviation, maximum, noise, bias;
};

Errors errors(const Grid<double>& model, const Grid<double>& a, const Grid<double>& b) {
  std::vector<double> relative;
  double square = 0, signal = 0, noise = 0, bias = 0;
  const double n = static_cast<double>(model.size());
  for (std::size_t i = 0; i < model.size(); ++i) {
    const double p = model.data()[i], u = a.data()[i], v = b.data()[i], image = (u + v) / 2;
    square += (p - u) * (p - v) / n;
    signal += image / n;
    noise += (u - v) * (u - v) / 4 / n;
    bias += (p - image) / n;
    relative.push_back(std::abs(p - image) / image);
  }
  std::sort(relative.begin(), relative.end());
  Errors e{};
  e.rms = std::sqrt(std::max(0.0, square)) / signal;
  e.noise = std::sqrt(noise) / signal;
  e.bias = bias / signal;
  for (const double r : relative) e.mean += r / n;
  for (const double r : relative) e.deviation += (r - e.mean) * (r - e.mean) / n;
  e.deviation = std::sqrt(e.deviation);
  // Of a normal error of deviation s the mean magnitude is s sqrt(2 / pi).
  const double folded = std::sqrt(2 / std::numbers::pi) * e.noise;
  e.mean_less_noise = std::sqrt(std::max(0.0, e.mean * e.mean - folded * folded));
  e.median = relative[relative.size() / 2];
  e.maximum = relative.back();
  return e;
}

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double median_ms(int runs, const std::function<void()>& work) {
  std::vector<double> times;
  for (int i = 0; i < runs; ++i) {
    const double start = cpu_seconds();
    work();
    times.push_back(1e3 * (cpu_seconds() - start));
  }
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

struct Model {
  std::string name;
  TrainedModel trained;
  std::shared_ptr<const ImageModel> model;
  double value_ms, gradient_ms;
};

Model load(const fs::path& path) {
  Model m{path.stem().string(), io::read_model(path), nullptr, 0, 0};
  m.model = make_model(m.trained);
  const double pixel = m.model->scope().pixel_nm > 0 ? m.model->scope().pixel_nm : 3;
  HeightField field = make_rough({299 * pixel, 299 * pixel, pixel}, 4 * pixel, 15 * pixel, 1);
  const ModelOptions one{.threads = 1};
  m.value_ms = median_ms(1, [&] { m.model->predict(field, one); });
  const int runs = std::clamp(static_cast<int>(2000 / m.value_ms), 1, 21);
  m.value_ms = median_ms(runs, [&] { m.model->predict(field, one); });
  const ModelImages weights(m.model->channels().size(), Grid<double>(300, 300, 1.0));
  m.gradient_ms =
      median_ms(std::max(1, runs / 3), [&] { m.model->linearize(field, one)->gradient(weights); });
  return m;
}

int index_of(const ImageModel& model, const std::string& channel) {
  const auto& names = model.channels();
  const auto at = std::find(names.begin(), names.end(), channel);
  return at == names.end() ? -1 : static_cast<int>(at - names.begin());
}

void write_picture(const fs::path& path, const std::vector<std::vector<Grid<double>>>& columns) {
  const int n = columns[0][0].width(), gap = 3;
  const int width = static_cast<int>(columns.size()) * (n + gap) - gap, height = 2 * n + gap;
  Image image;
  image.channels = {{"grey", "1", Grid<float>(width, height, 1.0F)}};
  for (int c = 0; c < 2; ++c) {
    double least = 1e300, most = 0;
    for (const double v : columns[0][c].data())
      least = std::min(least, v), most = std::max(most, v);
    for (std::size_t k = 0; k < columns.size(); ++k)
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
          image.channels[0].values(static_cast<int>(k) * (n + gap) + x, (1 - c) * (n + gap) + y) =
              static_cast<float>(
                  std::clamp((columns[k][c](x, y) - least) / (most - least), 0.0, 1.0));
  }
  io::write_image(path, image);
}

int run(const fs::path& folder, const std::vector<fs::path>& files) {
  fs::create_directories(folder);
  std::vector<Model> models;
  for (const fs::path& file : files) models.push_back(load(file));
  std::ofstream csv(folder / "models.csv");
  csv << "surface,model,channel,value_ms,gradient_ms,rms,mean,mean_less_noise,median,deviation,"
         "maximum,bias,noise\n";
  fmt::print("{:17} {:28} {:4} {:>9} {:>9} {:>6} {:>6} {:>9} {:>6} {:>6} {:>6} {:>6} {:>6}\n",
             "surface", "model", "", "value ms", "gradient", "rms %", "mean", "less noise",
             "median", "dev", "max", "bias", "noise");
  io::Plot plot;
  plot.title = "Error on surfaces not trained on against time for 300 x 300 pixels, one thread";
  for (const Surface& surface : surfaces()) {
    std::vector<const Model*> fitting;
    for (const Model& m : models)
      if (m.model->scope().pixel_nm == 0 ||
          std::abs(m.model->scope().pixel_nm - surface.pixel_nm) < 1e-3)
        fitting.push_back(&m);
    if (fitting.empty()) continue;
    const auto a = reference(surface, 0, folder), b = reference(surface, 1, folder);
    std::vector<std::vector<Grid<double>>> picture(1);
    for (int c = 0; c < 2; ++c) {
      Grid<double> mean = a[c];
      for (std::size_t i = 0; i < mean.size(); ++i)
        mean.data()[i] = (a[c].data()[i] + b[c].data()[i]) / 2;
      picture[0].push_back(std::move(mean));
    }
    io::PlotPanel panel;
    panel.title = surface.name;
    panel.x = {"time (ms)", true, {}};
    panel.y = {"rms error over mean signal", true, {}};
    std::map<std::string, io::PlotSeries> series;
    for (const Model* m : fitting) {
      const ModelImages images = m->model->predict(surface.field);
      picture.emplace_back();
      for (const std::string channel : {"SE", "BSE"}) {
        const int k = index_of(*m->model, channel), c = channel == "SE" ? 0 : 1;
        picture.back().push_back(k >= 0 ? images[k] : Grid<double>(a[c].width(), a[c].height()));
        if (k < 0) continue;
        const Errors e = errors(images[k], a[c], b[c]);
        fmt::print(
            "{:17} {:28} {:4} {:9.2f} {:9.2f} {:6.2f} {:6.2f} {:9.2f} {:6.2f} {:6.2f} {:6.1f} "
            "{:6.2f} {:6.2f}\n",
            surface.name, m->name, channel, m->value_ms, m->gradient_ms, 100 * e.rms, 100 * e.mean,
            100 * e.mean_less_noise, 100 * e.median, 100 * e.deviation, 100 * e.maximum,
            100 * e.bias, 100 * e.noise);
        csv << fmt::format(
            "{},{},{},{:.3f},{:.3f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f}\n",
            surface.name, m->name, channel, m->value_ms, m->gradient_ms, e.rms, e.mean,
            e.mean_less_noise, e.median, e.deviation, e.maximum, e.bias, e.noise);
        if (e.rms > 0) {
          io::PlotSeries& s = series[channel];
          s.name = channel;
          s.style = io::PlotStyle::points;
          s.x.push_back(m->value_ms);
          s.y.push_back(e.rms);
          if (channel == "SE") panel.notes.push_back({m->name, m->value_ms, e.rms});
        }
      }
    }
    for (auto& [name, s] : series) panel.series.push_back(std::move(s));
    if (!panel.series.empty()) plot.panels.push_back(std::move(panel));
    write_picture(folder / (surface.name + ".png"), picture);
  }
  plot.columns = 2;
  if (!plot.panels.empty()) io::write_plot(folder / "models.svg", plot);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "bench_models FOLDER MODEL.json ...\n");
    return 2;
  }
  return run(argv[1], {argv + 2, argv + argc});
}
