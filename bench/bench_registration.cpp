// SPDX-License-Identifier: GPL-3.0-or-later
// How well images are registered from no landmarks: random affine maps (any turn, scales 0.8 to 1.25 along each
// axis, shear up to 5 %, overlap from 50 %) of random surfaces.
//   bench_registration MODEL.json [COUNT [SEED [mi]]]
// MODEL.json: a fast model, samples/si-1keV-3nm.json. COUNT (300): maps of surfaces with a pose that can be known,
// half of 456 x 172 and half of 300 x 300 SEM pixels; a fifth as many of each pattern that repeats or slides, and of
// images that show different places. SEED (1). `mi`: by mutual information. How the images are made: registration_scenes.h.
// error: root mean square over the overlap of where SEM pixels are put less where they belong, SEM pixels.
// z: error over its own standard error; a mean square of 1 says that the standard error is right.
#include <algorithm>
#include <ctime>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "registration_scenes.h"
#include "surf/io/model_file.h"
#include "surf/registration/register_images.h"

namespace {

using namespace surf;

double error_px(const RegistrationScene& scene, const Affine& found) {
  const PlacedImage& sem = scene.sem;
  const PlacedImage& afm = scene.simulated;
  double sum = 0;
  int count = 0;
  for (int y = 0; y < sem.values.height(); y += 3)
    for (int x = 0; x < sem.values.width(); x += 3) {
      const Point2 p = sem.place_nm(x, y), a = scene.truth(p), b = found(p);
      const Point2 last = afm.place_nm(afm.values.width() - 1, afm.values.height() - 1);
      if (a.x < afm.origin_x_nm || a.y < afm.origin_y_nm || a.x > last.x || a.y > last.y) continue;
      sum += (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
      ++count;
    }
  return std::sqrt(sum / count) / sem.pitch_x_nm;
}

/// Clopper and Pearson's upper limit at 95 %, one-sided: where k or fewer of n have a chance of 5 %.
double upper_limit(int k, int n) {
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double p = 0.5 * (low + high);
    double sum = 0, term = std::pow(1 - p, n);
    for (int j = 0; j <= k; ++j) {
      sum += term;
      term *= double(n - j) / (j + 1) * p / (1 - p);
    }
    (sum > 0.05 ? low : high) = p;
  }
  return high;
}

/// Of all threads.
double cpu_s() {
  return double(std::clock()) / CLOCKS_PER_SEC;
}

const char* name_of(RegistrationVerdict v) {
  constexpr const char* names[] = {"verified", "ambiguous", "unconverged", "unrelated"};
  return names[static_cast<int>(v)];
}

struct Tally {
  int count = 0, verdicts[4] = {}, wrong = 0, off = 0, with_rivals = 0;
  std::vector<double> errors, seconds, zs, stderrs;
  int lost = 0;   // not accepted, and not near the truth either

  void print(const char* what) {
    const auto quantile = [](std::vector<double> v, double share) {
      if (v.empty()) return 0.0;
      std::sort(v.begin(), v.end());
      return v[static_cast<std::size_t>(share * double(v.size() - 1))];
    };
    double z2 = 0;
    for (const double z : zs) z2 += z * z / double(std::max<std::size_t>(1, zs.size()));
    fmt::print("{:<16} {:4}  verified {:4} ambiguous {:4} unconverged {:3} unrelated {:3} | error median {:.3f} p95 {:.3f} "
               "max {:.3f} | stderr median {:.3f} z^2 {:.2f} | over 0.3 px {:2} over 1 px {:2} lost {:2} | s median {:.2f} max {:.2f}\n",
               what, count, verdicts[0], verdicts[1], verdicts[2], verdicts[3], quantile(errors, 0.5), quantile(errors, 0.95),
               quantile(errors, 1), quantile(stderrs, 0.5), z2, off, wrong, lost, quantile(seconds, 0.5), quantile(seconds, 1));
  }
  void add(const Tally& o) {
    count += o.count;
    for (int i = 0; i < 4; ++i) verdicts[i] += o.verdicts[i];
    wrong += o.wrong, off += o.off, lost += o.lost, with_rivals += o.with_rivals;
    errors.insert(errors.end(), o.errors.begin(), o.errors.end());
    seconds.insert(seconds.end(), o.seconds.begin(), o.seconds.end());
    zs.insert(zs.end(), o.zs.begin(), o.zs.end());
    stderrs.insert(stderrs.end(), o.stderrs.begin(), o.stderrs.end());
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return fmt::print(stderr, "bench_registration MODEL.json [COUNT [SEED [mi]]]\n"), 2;
  const int wanted = argc > 2 ? std::atoi(argv[2]) : 300;
  const std::uint64_t seed = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1;
  const auto model = make_model(io::read_model(argv[1]));
  RegistrationOptions options;
  if (argc > 4 && std::string(argv[4]) == "mi") options.objective = RegistrationObjective::mutual_information;
  const bool verbose = std::getenv("VERBOSE") != nullptr;

  const auto run = [&](Pattern pattern, int count, std::uint64_t first) {
    Tally tally;
    for (int i = 0; i < count; ++i) {
      SceneMaker maker(model, seed * 1000003 + first + static_cast<std::uint64_t>(i));
      const RegistrationScene scene = i % 2 == 0 ? maker.make(pattern, 456, 172, 0.5) : maker.make(pattern, 300, 300, 0.5);
      const double start = cpu_s();
      const Registration r = register_images(scene.sem, scene.simulated, options);
      tally.seconds.push_back(cpu_s() - start);
      ++tally.count;
      ++tally.verdicts[static_cast<int>(r.verdict)];
      const double error = error_px(scene, r.sem_to_afm);
      if (r.verdict == RegistrationVerdict::verified) {
        tally.errors.push_back(error);
        tally.stderrs.push_back(r.stderr_px);
        tally.zs.push_back(error / r.stderr_px);
        tally.off += error > 0.3;
        tally.wrong += error > 1;
      } else if (error > 1) {
        ++tally.lost;
      }
      tally.with_rivals += !r.rivals.empty();
      if (verbose)
        fmt::print("  {} {} {} overlap {:.2f} error {:.3f} stderr {:.3f} blur {} score {:.3f} rivals {} {:.2f} s: {}\n", surf::name_of(pattern), i,
                   name_of(r.verdict), scene.overlap, error, r.stderr_px, r.blur_px, r.score, r.rivals.size(), tally.seconds.back(), r.reason);
      std::fflush(stdout);
    }
    tally.print(surf::name_of(pattern));
    return tally;
  };

  constexpr Pattern knowable[] = {Pattern::blocks, Pattern::bumps, Pattern::pits, Pattern::rough, Pattern::lines_with_ends};
  constexpr Pattern open[] = {Pattern::grating, Pattern::dots, Pattern::single_line, Pattern::unrelated};
  Tally all, none;
  for (std::size_t p = 0; p < std::size(knowable); ++p)
    all.add(run(knowable[p], (wanted + 4 - static_cast<int>(p)) / 5, 100000 * p));
  all.print("with a pose");
  const int false_ones = all.off;
  fmt::print("accepted {:.1f} %; accepted and off by more than 0.3 px: {} of {}, 95 % upper limit {:.2f} %\n",
             100.0 * all.verdicts[0] / std::max(1, all.count), false_ones, all.count, 100 * upper_limit(false_ones, all.count));
  for (std::size_t p = 0; p < std::size(open); ++p) none.add(run(open[p], (wanted + 4) / 5, 1000000 + 100000 * p));
  fmt::print("without a pose: accepted {} of {}, 95 % upper limit {:.2f} %; with rivals {}\n", none.verdicts[0], none.count,
             100 * upper_limit(none.verdicts[0], std::max(1, none.count)), none.with_rivals);
}
