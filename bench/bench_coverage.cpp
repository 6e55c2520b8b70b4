// SPDX-License-Identifier: GPL-3.0-or-later
// How far reconstructions are off and whether their error bars hold, nothing told, on folders that
// `semsurf sample` made, also by what the model does not know (--physics, --tip-lean,
// --gain-drift):
//   bench_coverage MODEL.json FOLDER ...
//   bench_coverage MODEL.json --foretell FOLDER ...   squares of the image that were left out
// The peer is the scan eroded by the true tip, put in place by the true map; "alone" is the
// reconstruction of the scan without the SEM image, put in place likewise. Errors are rms in nm,
// less the median; shares are of heights within one and two standard deviations (68 and 95 would be
// right), of the whole and by region (surf/workflow/reconstruct_job.h, RegionReport), and pooled.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>

#include "compare_truth.h"
#include "reconstruction/initial_surface.h"
#include "sample_truth.h"
#include "surf/workflow/reconstruct_job.h"

namespace {

using namespace surf;

struct Pooled {
  double pixels = 0, one = 0, two = 0;
};

/// Of a surface in the scan's frame, at the SEM image's pixels.
double off_in_place(const HeightField& surface, const workflow::SampleTruth& s) {
  const PlacedImage& i = s.sem.image;
  HeightField there = s.truth;
  there.z_nm = reconstruction::on_frame(
      surface, {i.values.width(), i.values.height(), i.pitch_x_nm, i.origin_x_nm, i.origin_y_nm},
      s.sem.sem_to_afm);
  return workflow::rms_off(there, s.truth);
}

void judge(const std::filesystem::path& model, const std::string& folder,
           std::map<std::string, Pooled>& pooled) {
  const workflow::SampleTruth s = workflow::read_sample(folder);
  workflow::ReconstructJob job;
  job.afm.emplace();
  job.afm->scan = s.scan;
  workflow::ReconstructJob alone = job;
  alone.options.uncertainty = false;
  job.sem.emplace();
  job.sem->image = s.sem.image;
  job.model.file = model;
  job.truth = s.truth;
  const auto begin = std::chrono::steady_clock::now();
  const workflow::ReconstructSummary r = workflow::run(job);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const double peer = off_in_place(reconstruction::eroded(s.afm, 0), s);
  fmt::print("{}: {}, {:.0f} s\n", folder, name(r.verdict), seconds);
  if (!r.truth) return;
  fmt::print(
      "  off {:.2f} nm, {:.2f} less a plane; peer {:.2f}, ratio {:.2f}; alone {:.2f}; the model is "
      "off by {:.1f} %\n",
      r.truth->rms_nm, r.truth->plane_rms_nm, peer, r.truth->rms_nm / peer,
      off_in_place(workflow::run(alone).result.surface, s), 100 * r.result.sem_discrepancy_share);
  const auto print = [&](const std::string& region, double pixels, double rms, double one,
                         double two) {
    fmt::print("  {:9} {:5.1f} %  off {:6.2f}  within one {:5.1f} %, two {:5.1f} %\n", region,
               100 * pixels / static_cast<double>(r.truth->pixels), rms, 100 * one, 100 * two);
    Pooled& all = pooled[region];
    all.pixels += pixels, all.one += pixels * one, all.two += pixels * two;
  };
  print("all", static_cast<double>(r.truth->pixels), r.truth->rms_nm, r.truth->coverage_1,
        r.truth->coverage_2);
  for (const workflow::RegionReport& region : r.truth->regions)
    print(region.name, static_cast<double>(region.pixels), region.rms_nm, region.coverage_1,
          region.coverage_2);
  for (const workflow::CorrectionRound& c : r.corrections)
    fmt::print("  Monte Carlo: SE off {:.1f} % (to {:.1f} %), moved {:.3f} nm, {:.0f} s\n",
               100 * c.off_share[0], 100 * c.error_share[0], c.moved_nm, c.seconds);
  std::fflush(stdout);
}

/// Every sixteenth square of 8 x 8 pixels, which the reconstruction does not see.
bool left_out(int x, int y) { return x / 8 % 4 == 1 && y / 8 % 4 == 1; }

/// How well left-out squares are foretold: rms over that of the noise, of pixels that are no
/// noisier than most.
void foretell(const std::filesystem::path& model, const std::string& folder) {
  const workflow::SampleTruth s = workflow::read_sample(folder);
  workflow::ReconstructJob job;
  job.afm.emplace();
  job.afm->scan = s.scan;
  job.sem.emplace();
  job.sem->image = s.sem.image;
  PlacedImage& image = job.sem->image;
  image.valid = Mask(image.values.width(), image.values.height(), 1);
  for (int y = 0; y < image.values.height(); ++y)
    for (int x = 0; x < image.values.width(); ++x)
      if (left_out(x, y)) image.valid(x, y) = 0;
  job.model.file = model;
  job.options.uncertainty = false;
  job.corrections = 0;
  fmt::print("{}: left-out squares are foretold to", folder);
  for (const double share : {0.0, 0.05}) {
    job.model_error = share;
    const workflow::ReconstructSummary r = workflow::run(job);
    double squares = 0, n = 0;
    for (int y = 0; y < image.values.height(); ++y)
      for (int x = 0; x < image.values.width(); ++x) {
        if (!left_out(x, y)) continue;
        double said = r.result.simulated_sem(x, y);
        if (!r.result.sem_discrepancy.empty()) said += r.result.sem_discrepancy(x, y);
        squares += std::pow(image.values(x, y) - said, 2) /
                   r.sem_noise->variance(r.result.simulated_sem(x, y));
        n += 1;
      }
    fmt::print(" {:.3f} of the noise with a model error of {:.0f} %{}", std::sqrt(squares / n),
               100 * share, share == 0 ? "," : "\n");
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "bench_coverage MODEL.json [--foretell] FOLDER ...\n");
    return 2;
  }
  if (std::string(argv[2]) == "--foretell") {
    for (int i = 3; i < argc; ++i) foretell(argv[1], argv[i]);
    return 0;
  }
  std::map<std::string, Pooled> pooled;
  for (int i = 2; i < argc; ++i) judge(argv[1], argv[i], pooled);
  fmt::print("pooled\n");
  for (const auto& [region, p] : pooled)
    fmt::print("  {:9} within one {:5.1f} %, two {:5.1f} %\n", region, 100 * p.one / p.pixels,
               100 * p.two / p.pixels);
}
