// SPDX-License-Identifier: GPL-3.0-or-later
// How fast images are predicted, with and without their gradient, beside what the vector unit can
// do at most.
//   bench_filter_bank [runs, default 31] [pixels of the largest field along a side, default 4096]
// Times are medians and least ones, CPU seconds of one thread: other programs on the machine slow
// both. The floor is the time that the operations alone would take at the peak of the vector unit,
// and the ratio is the median over the floor. Operations are counted as the passes do them on a
// field without a border: for each pixel and scale 11 one-dimensional passes of a multiply-add per
// pair of samples, and the sums and differences of the pairs; a transposed pass does the same, and
// a gradient makes the fits again. The network adds, in each direction, its sky samples, the four
// inputs of each scale, and its layers. At the end stands how far the time per pixel of the larger
// images is from the smallest.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "surf/core/random.h"
#include "surf/sem/facet_network.h"
#include "surf/sem/filter_bank.h"
#include "surf/sem/fit_facet_network.h"
#include "surf/sem/slope_model.h"

namespace {

using namespace surf;

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Time {
  double median = 0, least = 0;
};

template <class Work>
Time measure_time(int runs, const Work& work) {
  std::vector<double> seconds;
  for (int i = 0; i < runs; ++i) {
    const double start = cpu_seconds();
    work();
    seconds.push_back(cpu_seconds() - start);
  }
  std::sort(seconds.begin(), seconds.end());
  return {seconds[runs / 2], seconds[0]};
}

// Multiply-adds and additions on nothing but registers, as many of one as of the other, 10^9
// single-precision operations per second (a multiply-add is one).
#define PEAK(name, bytes, target)                                     \
  target double name() {                                              \
    typedef float V [[gnu::vector_size(bytes)]];                      \
    V sum[7] = {}, product[7] = {}, b = V{} + 1e-9F;                  \
    constexpr long steps = 4'000'000;                                 \
    const double start = cpu_seconds();                               \
    for (long i = 0; i < steps; ++i)                                  \
      for (int j = 0; j < 7; ++j) {                                   \
        sum[j] = sum[j] + b;                                          \
        product[j] = product[j] * b + b;                              \
        asm volatile("" : "+v"(sum[j]), "+v"(product[j]));            \
      }                                                               \
    return 1e-9 * steps * 14 * (bytes / 4) / (cpu_seconds() - start); \
  }
#ifdef __x86_64__
PEAK(peak_portable, 16, )
PEAK(peak_avx2, 32, [[gnu::target("avx2,fma")]])
PEAK(peak_avx512, 64, [[gnu::target("avx512f,fma,prefer-vector-width=512")]])

double peak() {
  double most = 0;  // of several: the machine may be doing other things
  for (int i = 0; i < 7; ++i)
    most = std::max(most, __builtin_cpu_supports("avx512f") ? peak_avx512()
                          : __builtin_cpu_supports("avx2")  ? peak_avx2()
                                                            : peak_portable());
  return most;
}
#else
double peak() { return std::numeric_limits<double>::quiet_NaN(); }
#endif

HeightField rough(int n) {
  HeightField f{{2, 2}, Grid<double>(n, n)};
  RandomStream random(1, 0, 0);
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      f.z_nm(x, y) = 10 * std::sin(0.05 * x) * std::cos(0.07 * y) + random.uniform();
  return f;
}

FilterBankParameters bank(const std::vector<FacetScale>& scales, bool multi_resolution = false) {
  FilterBankParameters p{scales, multi_resolution, {}};
  for (const char* name : {"SE", "BSE"})
    p.channels.push_back({name, 0.1, std::vector<double>(scales.size(), 0.1),
                          std::vector<double>(scales.size(), 0.2),
                          std::vector<double>(scales.size(), 0.3)});
  return p;
}

/// Of the shape that is learnt for silicon at 1 keV with 3 nm pixels; weights do not matter here.
FacetNetworkParameters network_parameters() {
  FacetNetworkParameters p;
  p.scales = network_scales(3, 30);
  p.sky_edges_nm = network_sky_edges(3, 30);
  p.channels = {{"SE", 1}, {"BSE", 0.2}};
  RandomStream random(2, 0, 0);
  int inputs = network_inputs(p);
  for (const int outputs : {32, 2}) {
    DenseLayer& layer = p.layers.emplace_back();
    layer.inputs = inputs;
    layer.outputs = outputs;
    for (int i = 0; i < inputs * outputs; ++i) layer.weights.push_back(random.uniform() - 0.5);
    for (int i = 0; i < outputs; ++i) layer.biases.push_back(random.uniform() - 0.5);
    inputs = outputs;
  }
  return p;
}

/// A pixel's operations: of its images, and of images and gradient.
struct Operations {
  double value = 0, both = 0;
};

Operations operations(const std::vector<FacetScale>& scales) {
  double count = 0;
  for (const FacetScale& scale : scales) count += 20.0 * (scale.size / 2) + 9;
  return {count, 3 * count};
}

Operations operations(const FacetNetworkParameters& p) {
  // An inverse root takes 11 operations; each input of a scale takes two. 12 samples a direction,
  // less the nearest bands of one step.
  constexpr double root = 11, sample = root + 9, sample_back = root + 25, facet = 8 * root + 30,
                   facet_back = facet + 50, samples = 180;
  const double scales = static_cast<double>(p.scales.size());
  double layers = 0;
  for (const DenseLayer& layer : p.layers) layers += layer.outputs * (layer.inputs + root + 4.0);
  const double value = operations(p.scales).value + samples * sample + scales * facet + layers;
  return {value, 2 * value + operations(p.scales).value * 2 + samples * sample_back +
                     scales * facet_back + layers};
}

struct Row {
  Time value, both;
};

Row measure(const ImageModel& model, const HeightField& field, int runs) {
  const ModelOptions one{.threads = 1};
  Row row;
  row.value = measure_time(runs, [&] { model.predict(field, one); });
  ModelImages weights(model.channels().size(),
                      Grid<double>(field.z_nm.width(), field.z_nm.height(), 0.5));
  row.both = measure_time(runs, [&] { model.linearize(field, one)->gradient(weights); });
  return row;
}

void print(const std::string& name, const Row& row, double pixels, const Operations& count,
           double peak) {
  const auto columns = [&](const Time& time, double operations) {
    const double floor = 1e-9 * operations * pixels / peak;
    return fmt::format(" {:9.2f} {:8.2f} {:8.1f} {:8.2f} {:6.2f}", 1e3 * time.median,
                       1e3 * time.least, 1e9 * time.median / pixels, 1e3 * floor,
                       time.median / floor);
  };
  fmt::print("{:<24}{}{}\n", name, columns(row.value, count.value), columns(row.both, count.both));
  std::fflush(stdout);
}

/// Least times per pixel of one model at several sizes of the image.
struct Flatness {
  std::vector<double> value, both;

  void add(const Row& row, double pixels) {
    value.push_back(row.value.least / pixels);
    both.push_back(row.both.least / pixels);
  }
  static double most(const std::vector<double>& times) {
    return *std::max_element(times.begin(), times.end()) /
           *std::min_element(times.begin(), times.end());
  }
  void print(const char* name) const {
    fmt::print("{}: largest over smallest time per pixel {:.2f}, with gradient {:.2f}\n", name,
               most(value), most(both));
  }
};

}  // namespace

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::max(1, std::atoi(argv[1])) : 31;
  const int most_pixels = argc > 2 ? std::atoi(argv[2]) : 4096;
  const std::vector<FacetScale> all = thesis_scales();
  const Operations of_bank = operations(all), of_network = operations(network_parameters());
  const double most = peak();
  fmt::print(
      "{:.0f} operations a pixel for ten scales, {:.0f} for the network; peak {:.0f} 10^9/s\n\n",
      of_bank.value, of_network.value, most);
  fmt::print("{:<24} {:<44}{}\n", "SE and BSE, one thread", "images", "images and gradient");
  fmt::print("{:<24}", "");
  for (int i = 0; i < 2; ++i)
    fmt::print(" {:>9} {:>8} {:>8} {:>8} {:>6}", "ms", "least", "ns/pixel", "floor", "ratio");
  fmt::print("\n");
  const HeightField field = rough(300);
  const auto full = make_filter_bank({}, bank(all));
  print("300 x 300, ten scales", measure(*full, field, runs), 90000, of_bank, most);
  for (const FacetScale& scale : all)
    print(fmt::format("  {} x {} alone", scale.size, scale.size),
          measure(*make_filter_bank({}, bank({scale})), field, runs), 90000, operations({scale}),
          most);
  print("  multi-resolution", measure(*make_filter_bank({}, bank(all, true)), field, runs), 90000,
        of_bank, most);
  SlopeModelParameters slopes{SlopeForm::table, 5, {5, 0.6}, {}};
  for (const char* name : {"SE", "BSE"})
    slopes.channels.push_back({name, 1, std::vector<double>(18, 1.0)});
  print("  table of the slope", measure(*make_slope_model({}, slopes), field, runs), 90000,
        operations({{5, 0.6}}), most);
  slopes.form = SlopeForm::secant;
  print("  secant", measure(*make_slope_model({}, slopes), field, runs), 90000,
        operations({{5, 0.6}}), most);
  ModelScope scope;
  scope.pixel_nm = 2;
  const auto net = make_facet_network(scope, network_parameters());
  print("  facet network", measure(*net, field, runs), 90000, of_network, most);
  Flatness bank_flatness, network_flatness;
  for (int n = 128; n <= most_pixels; n *= 2) {
    const HeightField large = rough(n);
    const double pixels = static_cast<double>(n) * n;
    const int fewer = std::clamp(runs * 300 / n, std::min(runs, 3), runs);
    const Row of_full = measure(*full, large, fewer);
    print(fmt::format("{} x {}", n, n), of_full, pixels, of_bank, most);
    bank_flatness.add(of_full, pixels);
    const Row of_net = measure(*net, large, fewer);
    print("  facet network", of_net, pixels, of_network, most);
    network_flatness.add(of_net, pixels);
  }
  if (most_pixels < 128) return 0;
  bank_flatness.print("\nfilter bank");
  network_flatness.print("facet network");
}
