// SPDX-License-Identifier: GPL-3.0-or-later
// What reconstructions spend on linear systems, in double precision (CHOLMOD) and in single, in
// turn in the same run:
//   bench_solves [--whole] [SURFACE] [SIDE ...]
// SURFACE is a sample surface (pads), SIDEs are pixels of the SEM image (64 128 256). --whole
// reconstructs with both, too. The SEM model is the quickest there is, one of the slope, so that
// systems take the largest share of the time.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "reconstruction/initial_surface.h"
#include "reconstruction/objective.h"
#include "reconstruction/preconditioner.h"
#include "surf/afm/morphology.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/parallel.h"
#include "surf/core/random.h"
#include "surf/reconstruction/reconstruct.h"
#include "surf/reconstruction/sample_surfaces.h"
#include "surf/sem/slope_model.h"

// Functions of OpenBLAS, to measure the peak.
extern "C" {
void sgemm_(const char*, const char*, const int*, const int*, const int*, const float*,
            const float*, const int*, const float*, const int*, const float*, float*, const int*);
void dgemm_(const char*, const char*, const int*, const int*, const int*, const double*,
            const double*, const int*, const double*, const int*, const double*, double*,
            const int*);
}

namespace {

using namespace surf;
using namespace surf::reconstruction;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Medians of the times that both take, in turn, ms.
template <class First, class Second>
std::pair<double, double> in_turn(int times, const First& first, const Second& second) {
  std::vector<double> a, b;
  for (int i = 0; i < times; ++i) {
    const double begin = now();
    first();
    const double middle = now();
    second();
    a.push_back(1e3 * (middle - begin));
    b.push_back(1e3 * (now() - middle));
  }
  const auto median = [](std::vector<double>& v) {
    std::nth_element(v.begin(), v.begin() + v.size() / 2, v.end());
    return v[v.size() / 2];
  };
  return {median(a), median(b)};
}

template <class Work>
double ms(const Work& work) {
  return in_turn(7, work, [] {}).first;
}

/// Both images of a sample surface, with noise of their kinds, on `side` x `side` pixels of 10 nm.
struct Scene {
  AfmData afm;
  SemData sem;
  HeightField truth;

  Scene(const SampleSurface& surface, int side) {
    const double pitch = 10, corner = -0.5 * (side - 1) * pitch;
    truth = {{pitch, pitch, corner, corner}, Grid<double>(side, side)};
    sample_heights(surface, {}, truth, 0);
    SlopeModelParameters p;
    SlopeChannel channel;
    channel.name = "SE";
    p.channels = {channel};
    sem.model = make_slope_model({}, p);
    sem.gains = {100};
    sem.offset = 20;
    sem.noise = {0.05, 1, 0.1};
    sem.sem_to_afm = make_affine({0.3, 1.04, 0.97, 0.02, 15, -8});
    sem.image = {{pitch, pitch, corner, corner}, sem.model->predict(truth)[0]};
    RandomStream random(5, 1, 0);
    for (double& v : sem.image.values.data()) {
      v = 100 * v + 20;
      v += std::sqrt(sem.noise.variance(v)) * std::sqrt(-2 * std::log(random.uniform())) *
           std::cos(6.283185307179586 * random.uniform());
    }
    const double coarse = 20;
    const int n = side / 2 + 20, f = 3;
    const double edge = -0.5 * (n - 1) * coarse;
    HeightField fine{{coarse / f, coarse / f, edge, edge},
                     Grid<double>((n - 1) * f + 1, (n - 1) * f + 1)};
    sample_heights(surface, inverse(sem.sem_to_afm), fine, 0);
    const HeightField image = dilate(fine, parabolic_tip(60, {coarse / f, coarse / f, 43, 43}));
    afm.image = {{coarse, coarse, edge, edge}, Grid<double>(n, n)};
    afm.noise = {0.825, 0.201};
    const Grid<double> e = simulate_noise(afm.noise, n, n, 5);
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) afm.image.z_nm(x, y) = image.z_nm(f * x, f * y) + e(x, y);
    afm.tip = parabolic_tip(60, {coarse, coarse, 15, 15});
    afm.upsample = f;
  }
};

double rms_difference(const Grid<double>& a, const Grid<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(a.data()[i] - b.data()[i], 2);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

/// What the machine can do at most: Gflop/s of one thread's products of matrices, and GB/s that all
/// threads read together.
void print_machine() {
  const int n = 768;
  std::vector<float> a(n * n, 1), b = a, c = a;
  std::vector<double> p(n * n, 1), q = p, r = p;
  const float one = 1;
  const double unit = 1;
  const OneBlasThread alone;
  const double s = ms(
      [&] { sgemm_("N", "T", &n, &n, &n, &one, a.data(), &n, b.data(), &n, &one, c.data(), &n); });
  const double d = ms([&] {
    dgemm_("N", "T", &n, &n, &n, &unit, p.data(), &n, q.data(), &n, &unit, r.data(), &n);
  });
  std::vector<std::vector<std::uint64_t>> large(resolve_threads(0));
  std::vector<std::uint64_t> sums(large.size());
  for (auto& v : large) v.assign(16u << 20, 1);
  const double read = ms([&] {
    parallel_for(large.size(), 0, [&](std::size_t i, int) {
      std::uint64_t sum = 0;
      for (const std::uint64_t v : large[i]) sum += v;
      sums[i] = sum;
    });
  });
  fmt::print(
      "the machine: {:.0f} Gflop/s a thread in double, {:.0f} in single precision; {} threads read "
      "{:.0f} GB/s{}\n",
      2e-6 * n * n * n / d, 2e-6 * n * n * n / s, large.size(),
      1e-6 * 8 * (16u << 20) * static_cast<double>(large.size()) / read, sums[0] == 0 ? "!" : "");
}

void print_systems(const Scene& s, const Grid<double>* surface) {
  const SurfaceFrame frame = frame_of(&s.afm, &s.sem, 12);
  Objective o{.prior = CurvaturePrior(frame.pitch_nm, 2e-3), .frame = frame};
  o.fit_map = o.fit_mixture = true;
  const HeightField outside = eroded(s.afm, 0);
  o.afm.emplace(s.afm, outside, frame, s.sem.sem_to_afm, 0);
  o.sem.emplace(s.sem, frame, 12, 12, 0);
  Unknowns at{
      on_frame(outside, frame, s.sem.sem_to_afm), s.sem.sem_to_afm, {s.sem.gains, s.sem.offset}};
  if (surface)
    for (int y = 0; y < surface->height(); ++y)
      for (int x = 0; x < surface->width(); ++x) at.z_nm(x + 12, y + 12) = (*surface)(x, y);
  const Objective::State state = o.evaluate(at);
  const Step g = o.gradient(at, state);
  const Objective::Near near = o.near(at, state);
  fmt::print("  objective {:.1f} ms, gradient {:.1f}, sparse model {:.1f}, product {:.1f}\n",
             ms([&] { o.evaluate(at); }), ms([&] { o.gradient(at, state); }),
             ms([&] { o.near(at, state); }), ms([&] { o.product(at, state, g, &near); }));

  Preconditioner d(Preconditioner::usual_tile_px, 0, Precision::double_always),
      f(Preconditioner::usual_tile_px, 0);
  const auto first = in_turn(
      1, [&] { d.factor(o, at, state); }, [&] { f.factor(o, at, state); });
  const auto factor = in_turn(
      7, [&] { d.factor(o, at, state); }, [&] { f.factor(o, at, state); });
  const auto solve = in_turn(
      41, [&] { d.solve(g); }, [&] { f.solve(g); });
  const std::vector<Step> six(6, g);
  const auto together = in_turn(
      9, [&] { d.solve(six); }, [&] { f.solve(six); });
  const auto draws = in_turn(
      5, [&] { d.variances(o.prior, 12, 1, {}); }, [&] { f.variances(o.prior, 12, 1, {}); });
  const auto print = [](const char* what, std::pair<double, double> t) {
    fmt::print("  {:28} {:9.2f} {:9.2f} {:7.2f}\n", what, t.first, t.second, t.second / t.first);
  };
  fmt::print("  {:28} {:>9} {:>9} {:>7}\n", "ms", "double", "single", "ratio");
  print("first factor, with analysis", first);
  print("factor", factor);
  print("solution", solve);
  print("six solutions at once", together);
  print("twelve draws", draws);
  print("MB of factors",
        {1e-6 * static_cast<double>(d.bytes()), 1e-6 * static_cast<double>(f.bytes())});
  const Step exact = d.solve(g), coarse = f.solve(g);
  fmt::print(
      "  {} tiles, {} of them in double precision; a solution is off by {:.1e} of its rms; factors "
      "of single precision "
      "take {:.2f} Gflop\n",
      f.tiles(), f.double_tiles(),
      rms_difference(exact.z_nm, coarse.z_nm) /
          rms_difference(exact.z_nm, Grid<double>(exact.z_nm.width(), exact.z_nm.height())),
      1e-9 * f.flops());
}

Reconstruction print_whole(const Scene& s) {
  ReconstructionOptions single, twice;
  single.uncertainty = twice.uncertainty = false;
  twice.double_precision = true;
  Reconstruction a, b;
  const auto bare = in_turn(
      s.truth.z_nm.size() > 20000 ? 1 : 3, [&] { a = reconstruct(&s.afm, &s.sem, twice); },
      [&] { b = reconstruct(&s.afm, &s.sem, single); });
  single.uncertainty = twice.uncertainty = true;
  Reconstruction p, q;
  const auto judged = in_turn(
      1, [&] { p = reconstruct(&s.afm, &s.sem, twice); },
      [&] { q = reconstruct(&s.afm, &s.sem, single); });
  // Contacts decide which way a descent goes, so compare with what a change far below the noise
  // does, in double precision.
  AfmData taller = s.afm;
  for (double& z : taller.image.z_nm.data()) z *= 1.0001;
  const Reconstruction moved = reconstruct(&taller, &s.sem, twice);
  const auto objective = [](const Reconstruction& r) {
    return r.scales.back().afm + r.scales.back().sem + r.scales.back().prior;
  };
  const auto apart = [](const Reconstruction& r, const Reconstruction& t) {
    double sum = 0;
    for (std::size_t i = 0; i < r.deviation_nm.size(); ++i)
      sum += std::pow(std::log(r.deviation_nm.data()[i] / t.deviation_nm.data()[i]), 2);
    return 100 * std::sqrt(sum / static_cast<double>(r.deviation_nm.size()));
  };
  const auto products = [](const Reconstruction& r) {
    int sum = 0;
    for (const ScaleReport& scale : r.scales) sum += scale.products;
    return sum;
  };
  fmt::print(
      "  reconstruction {:.2f} s in double, {:.2f} in single precision, {} and {} products; with "
      "deviations {:.2f}, {:.2f} s\n",
      1e-3 * bare.first, 1e-3 * bare.second, products(a), products(b), 1e-3 * judged.first,
      1e-3 * judged.second);
  const auto print = [&](const char* what, const Reconstruction& r) {
    fmt::print(
        "  {:32} objective {:.1f}, rms error {:.3f} nm; surface off by {:.4f} nm rms, deviations "
        "by {:.1f} %\n",
        what, objective(r), rms_difference(r.surface.z_nm, s.truth.z_nm),
        rms_difference(p.surface.z_nm, r.surface.z_nm), apart(r, p));
  };
  print("double precision", p);
  print("double, of a scan 0.01 % taller", moved);
  print("single precision", q);
  return b;
}

}  // namespace

int main(int argc, char** argv) {
  bool whole = false;
  std::string surface = "pads";
  std::vector<int> sides;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--whole") whole = true;
    else if (std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; }))
      sides.push_back(std::stoi(word));
    else surface = word;
  }
  if (sides.empty()) sides = {64, 128, 256};
  setvbuf(stdout, nullptr, _IOLBF, 0);  // large sides take long
  print_machine();
  for (const int side : sides) {
    const Scene scene(find_sample_surface(surface), side);
    fmt::print("{}, {} x {} pixels\n", surface, side, side);
    if (whole) {
      const Reconstruction r = print_whole(scene);
      print_systems(scene, &r.surface.z_nm);
    } else {
      print_systems(scene, nullptr);
    }
  }
  return 0;
}
