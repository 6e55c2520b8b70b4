// SPDX-License-Identifier: GPL-3.0-or-later
// How fast scans are dilated, eroded and judged: beside what the vector unit can do at most, and
// beside Gwyddion's library where it is there, on the same arrays.
//   bench_morphology [pixels, default 512] [tip pixels, default 41]
// White noise and a rough tip leave nothing to skip; with a scan and a cone bounds leave out most,
// and what is counted as of the peak would be all. Times are the best of some runs, CPU seconds for
// one thread, wall time for two.
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <string>

#include <fmt/core.h>

#include "afm/max_plus.h"
#include "surf/afm/certainty.h"
#include "surf/afm/morphology.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/random.h"

#ifdef SEMSURF_GWYDDION
#include <libprocess/gwyprocess.h>
#endif

namespace {

using namespace surf;

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class Work>
double best_of(int runs, double (*clock)(), const Work& work) {
  double best = 1e9;
  for (int i = 0; i < runs; ++i) {
    const double start = clock();
    work();
    best = std::min(best, clock() - start);
  }
  return best;
}

// Additions each with a maximum, on nothing but registers, 10^9 per second.
#define PEAK(name, bytes, target)                                    \
  target double name() {                                             \
    typedef int V [[gnu::vector_size(bytes)]];                       \
    V best[6] = {}, b = V{} + 1;                                     \
    constexpr long steps = 10'000'000;                               \
    const double start = cpu_seconds();                              \
    for (long i = 0; i < steps; ++i)                                 \
      for (V & v : best) {                                           \
        V s = v + b;                                                 \
        asm volatile("" : "+v"(s));                                  \
        v = s > v ? s : v;                                           \
        asm volatile("" : "+v"(v));                                  \
      }                                                              \
    return 1e-9 * steps * 6 * (bytes / 4) / (cpu_seconds() - start); \
  }
#ifdef __x86_64__
PEAK(peak_portable, 16, )
PEAK(peak_avx2, 32, [[gnu::target("avx2")]])
PEAK(peak_avx512, 64, [[gnu::target("avx512f,avx512bw,avx512vl,prefer-vector-width=512")]])

double peak() {
  double most = 0;  // of several: the machine may be doing other things
  for (int i = 0; i < 5; ++i)
    most = std::max(most, __builtin_cpu_supports("avx512bw") ? peak_avx512()
                          : __builtin_cpu_supports("avx2")   ? peak_avx2()
                                                             : peak_portable());
  return most;
}
#else
double peak() { return std::numeric_limits<double>::quiet_NaN(); }
#endif

double normal(RandomStream& random) {
  return std::sqrt(-2 * std::log(random.uniform())) *
         std::cos(2 * std::numbers::pi * random.uniform());
}

HeightField smooth_scan(int n, double noise) {
  HeightField f{{}, Grid<double>(n, n)};
  RandomStream random(1, 0, 0);
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      f.z_nm(x, y) = 5 * std::sin(0.05 * x) * std::cos(0.07 * y) + (x / 40 % 2 ? 10 : 0) +
                     noise * normal(random);
  return f;
}

HeightField white_scan(int n) {
  HeightField f{{}, Grid<double>(n, n)};
  RandomStream random(2, 0, 0);
  for (double& z : f.z_nm.data()) z = 20 * random.uniform();
  return f;
}

// With white noise: no bound can leave anything out.
Tip random_tip(int n) {
  Tip tip{{1, 1}, Grid<double>(n, n), n / 2, n / 2};
  RandomStream random(3, 0, 0);
  for (double& z : tip.z_nm.data()) z = -10 * random.uniform();
  tip.z_nm(tip.apex_x, tip.apex_y) = 0;
  return tip;
}

#ifdef SEMSURF_GWYDDION
GwyDataField* to_gwy(const Grid<double>& z) {
  GwyDataField* field = gwy_data_field_new(z.width(), z.height(), z.width(), z.height(), FALSE);
  double* data = gwy_data_field_get_data(field);
  for (int y = 0; y < z.height(); ++y)
    for (int x = 0; x < z.width(); ++x) data[(z.height() - 1 - y) * z.width() + x] = z(x, y);
  return field;
}

using GwyFunction = GwyDataField* (*)(GwyDataField*, GwyDataField*, GwyDataField*,
                                      GwySetFractionFunc, GwySetMessageFunc);
gboolean go_on(gdouble) { return TRUE; }
gboolean be_silent(const gchar*) { return TRUE; }

/// Seconds; with `ours`, `difference` is the largest where the whole tip meets the surface.
double gwyddion(GwyFunction function, const Grid<double>& surface, const Tip& tip,
                const Grid<double>* ours = nullptr, double* difference = nullptr) {
  GwyDataField *s = to_gwy(surface), *t = to_gwy(tip.z_nm),
               *result = gwy_data_field_new_alike(s, FALSE);
  const double seconds = best_of(2, cpu_seconds, [&] { function(t, s, result, go_on, be_silent); });
  const double* data = gwy_data_field_get_data_const(result);
  const int w = surface.width(), h = surface.height(), rx = tip.z_nm.width(),
            ry = tip.z_nm.height();
  for (int y = ry; ours && y < h - ry; ++y)
    for (int x = rx; x < w - rx; ++x)
      *difference = std::max(*difference, std::abs(data[(h - 1 - y) * w + x] - (*ours)(x, y)));
  for (GwyDataField* field : {s, t, result}) g_object_unref(field);
  return seconds;
}
#endif

struct Row {
  const char* name;
  double one = 0, two = 0, theirs = std::numeric_limits<double>::quiet_NaN();
};

void print(const Row& row, double operations, double peak) {
  fmt::print("{:<44} {:8.2f} {:8.2f} {:8.0f}%", row.name, 1e3 * row.one, 1e3 * row.two,
             100e-9 * operations / row.one / peak);
  if (std::isnan(row.theirs)) fmt::print("\n");
  else fmt::print(" {:9.0f} {:8.1f}\n", 1e3 * row.theirs, row.theirs / row.one);
}

template <class Work>
Row measure(const char* name, const Work& work) {
  return {name, best_of(9, cpu_seconds, [&] { work(1); }),
          best_of(9, wall_seconds, [&] { work(2); })};
}

}  // namespace

int main(int argc, char** argv) {
  const int n = argc > 1 ? std::atoi(argv[1]) : 512, m = argc > 2 ? std::atoi(argv[2]) : 41;
  const double operations = static_cast<double>(n) * n * m * m, most = peak();
  fmt::print(
      "{} x {} by {} x {}: {:.0f} million additions and maxima; peak {:.1f} G/s, so {:.2f} ms at "
      "least\n\n",
      n, n, m, m, 1e-6 * operations, most, 1e-6 * operations / most);
  fmt::print("{:<44} {:>8} {:>8} {:>9} {:>9} {:>8}\n", "", "1 thread", "2", "of peak", "Gwyddion",
             "ratio");
  fmt::print("{:<44} {:>8} {:>8} {:>9} {:>9}\n", "", "ms", "ms", "", "ms");

  const HeightField scan = smooth_scan(n, 0.1), white = white_scan(n);
  const Tip cone = conical_tip(10, 0.35, {1, 1, m, m}), rough = random_tip(m);
  const auto run = [&](const char* name, const HeightField& f, const Tip& t, auto function) {
    return measure(name,
                   [&](int threads) { function(f, t, MorphologyOptions{.threads = threads}); });
  };
  Row dilation = run("dilation, white noise, rough tip", white, rough, dilate);
  Row contacts = run("the same with contact points", white, rough, dilate_with_contacts);
  Row erosion = run("erosion, white noise, rough tip", white, rough, erode);
  Row cone_dilation = run("dilation, scan, cone", scan, cone, dilate);
  Row cone_contacts = run("the same with contact points", scan, cone, dilate_with_contacts);
  Row cone_erosion = run("erosion, scan, cone", scan, cone, erode);
  Row map = measure("certainty map, scan, cone, noise 0.1 nm", [&](int threads) {
    certainty_map(scan, cone, {.noise_nm = 0.1, .threads = threads});
  });
  Row plain = measure("certainty map without tolerance",
                      [&](int threads) { certainty_map(scan, cone, {.threads = threads}); });
#ifdef SEMSURF_GWYDDION
  gwy_process_type_init();
  const Grid<double> dilated = dilate(scan, cone).z_nm, eroded = erode(scan, cone).z_nm;
  double difference = 0;
  dilation.theirs = gwyddion(gwy_tip_dilation, white.z_nm, rough);
  erosion.theirs = gwyddion(gwy_tip_erosion, white.z_nm, rough);
  cone_dilation.theirs = gwyddion(gwy_tip_dilation, scan.z_nm, cone, &dilated, &difference);
  cone_erosion.theirs = gwyddion(gwy_tip_erosion, scan.z_nm, cone, &eroded, &difference);
  plain.theirs = gwyddion(gwy_tip_cmap, scan.z_nm, cone);
#endif
  for (const Row& row :
       {dilation, contacts, erosion, cone_dilation, cone_contacts, cone_erosion, map, plain})
    print(row, operations, most);
#ifdef SEMSURF_GWYDDION
  fmt::print(
      "\nlargest difference of dilation and erosion from Gwyddion's, away from the border: {:.1e} "
      "nm\n",
      difference);
#endif
}
