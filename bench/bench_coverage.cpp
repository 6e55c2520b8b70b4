// SPDX-License-Identifier: GPL-3.0-or-later
// How far reconstructions are off and whether their error bars hold, nothing told, on folders that
// `semsurf sample` made, also by what the model does not know (--physics, --tip-lean,
// --gain-drift):
//   bench_coverage MODEL.json FOLDER ...
//   bench_coverage MODEL.json --without-corrections [--model-error SHARE] FOLDER ...
//   bench_coverage MODEL.json --chart CHART.svg FOLDER ...   error against time
//   bench_coverage MODEL.json --foretell FOLDER ...   squares of the image that were left out
// The peer is the scan eroded by the true tip, put in place by the true map; "alone" is the
// reconstruction of the scan without the SEM image, put in place likewise. Errors are rms in nm,
// less the median; shares are of heights within one and two standard deviations (68 and 95 would be
// right). "Held" are the heights that something holds: of all that are not flat the 80 % whose
// posterior deviation at the truth, with true tip, map and noise, is least. "Interval" is that of
// 95 %, from draws. Of the whole and by region (surf/workflow/reconstruct_job.h, RegionReport), and
// pooled.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>

#include "compare_truth.h"
#include "reconstruction/initial_surface.h"
#include "sample_truth.h"
#include "surf/io/plot.h"
#include "surf/workflow/reconstruct_job.h"

namespace {

using namespace surf;

struct Pooled {
  double pixels = 0, one = 0, two = 0, interval = 0;
};

/// Begins, and ends, at a state.
class At final : public ReconstructionJournal {
 public:
  explicit At(ReconstructionState state) : state_(std::move(state)) {}
  std::optional<ReconstructionState> found() override { return state_; }
  void keep(const ReconstructionState&) override {}

 private:
  ReconstructionState state_;
};

/// The posterior deviations at the truth.
Grid<double> deviations_at_truth(workflow::SampleTruth s, const workflow::StoredModel& model) {
  workflow::give_model(s, model.model);
  s.sem.discrepancy = usual_discrepancy(s.sem.image, workflow::ReconstructJob().model_error);
  constexpr int margin = 12;
  ReconstructionState state;
  const int w = s.truth.z_nm.width(), h = s.truth.z_nm.height();
  state.surface = s.truth;
  state.surface.z_nm = Grid<double>(w + 2 * margin, h + 2 * margin);
  for (int y = 0; y < h + 2 * margin; ++y)
    for (int x = 0; x < w + 2 * margin; ++x)
      state.surface.z_nm(x, y) =
          s.truth.z_nm(std::clamp(x - margin, 0, w - 1), std::clamp(y - margin, 0, h - 1));
  state.sem_to_afm = s.sem.sem_to_afm;
  state.gains = s.sem.gains;
  state.offset = s.sem.offset;
  for (const double scale : default_scales_px(ReconstructionMethod::gauss_newton, w, h)) {
    ScaleReport report;
    report.sigma_px = scale;
    report.curvature_prior_per_nm = 1e-3 * scale * scale;
    report.ended = "converged";
    state.scales.push_back(report);
  }
  At at(std::move(state));
  return reconstruct(&s.afm, &s.sem, {}, &at).deviation_nm;
}

/// Where something holds a height that is not flat ground.
Mask held(const workflow::SampleTruth& s, const workflow::StoredModel& model) {
  constexpr double share = 0.8, flat = 0.1;
  const Grid<double> deviation = deviations_at_truth(s, model);
  const Grid<double>& z = s.truth.z_nm;
  Mask bent(z.width(), z.height());
  std::vector<double> known;
  for (int y = 1; y + 1 < z.height(); ++y)
    for (int x = 1; x + 1 < z.width(); ++x) {
      const double slope = std::hypot(z(x + 1, y) - z(x - 1, y), z(x, y + 1) - z(x, y - 1)) /
                           (2 * s.truth.pitch_x_nm);
      bent(x, y) = slope > flat;
      if (bent(x, y)) known.push_back(deviation(x, y));
    }
  if (known.empty()) return bent;
  std::ranges::sort(known);
  const double most = known[static_cast<std::size_t>(share * double(known.size() - 1))];
  for (std::size_t i = 0; i < bent.size(); ++i)
    bent.data()[i] = bent.data()[i] && deviation.data()[i] <= most;
  return bent;
}

double rms_within(const Mask& mask, const Grid<double>& z, const Grid<double>& truth,
                  double offset_nm) {
  double squares = 0, n = 0;
  for (std::size_t i = 0; i < z.size(); ++i)
    if (mask.data()[i]) squares += std::pow(z.data()[i] - truth.data()[i] - offset_nm, 2), n += 1;
  return n > 0 ? std::sqrt(squares / n) : 0;
}

/// A surface in the scan's frame at the SEM image's pixels.
Grid<double> in_place(const HeightField& surface, const workflow::SampleTruth& s) {
  const PlacedImage& i = s.sem.image;
  return reconstruction::on_frame(
      surface, {i.values.width(), i.values.height(), i.pitch_x_nm, i.origin_x_nm, i.origin_y_nm},
      s.sem.sem_to_afm);
}

double off_in_place(const HeightField& surface, const workflow::SampleTruth& s) {
  HeightField there = s.truth;
  there.z_nm = in_place(surface, s);
  return workflow::rms_off(there, s.truth);
}

void judge(const std::filesystem::path& model, const std::string& folder, int corrections,
           double model_error, std::map<std::string, Pooled>& pooled) {
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
  job.corrections = corrections;
  job.model_error = model_error;
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
                         double two, double interval) {
    fmt::print(
        "  {:9} {:5.1f} %  off {:6.2f}  within one {:5.1f} %, two {:5.1f} %, interval {:5.1f} %\n",
        region, 100 * pixels / static_cast<double>(r.truth->pixels), rms, 100 * one, 100 * two,
        100 * interval);
    Pooled& all = pooled[region];
    all.pixels += pixels, all.one += pixels * one, all.two += pixels * two;
    all.interval += pixels * interval;
  };
  print("all", static_cast<double>(r.truth->pixels), r.truth->rms_nm, r.truth->coverage_1,
        r.truth->coverage_2, r.truth->in_interval);
  for (const workflow::RegionReport& region : r.truth->regions)
    print(region.name, static_cast<double>(region.pixels), region.rms_nm, region.coverage_1,
          region.coverage_2, region.in_interval);
  const Mask where = held(s, *r.model);
  const HeightField eroded = reconstruction::eroded(s.afm, 0);
  const double ours = rms_within(where, r.result.surface.z_nm, s.truth.z_nm, r.truth->offset_nm),
               theirs = rms_within(where, in_place(eroded, s), s.truth.z_nm, 0);
  fmt::print("  held      off {:.2f} nm, peer {:.2f}, ratio {:.2f}\n", ours, theirs, ours / theirs);
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
    fmt::print(" {:.3f} of the noise with a model error of {:.0f} %,", std::sqrt(squares / n),
               100 * share);
  }
  fmt::print("\n");
  std::fflush(stdout);
}

/// Error against time: the scan alone, and both images without corrections and with.
io::PlotPanel panel_of(const std::filesystem::path& model, const std::string& folder) {
  const workflow::SampleTruth s = workflow::read_sample(folder);
  workflow::ReconstructJob job;
  job.afm.emplace();
  job.afm->scan = s.scan;
  job.options.uncertainty = false;
  io::PlotPanel panel;
  panel.title = std::filesystem::path(folder).filename().string();
  panel.x = {"time on this machine (s)", true, {}};
  panel.y = {"root-mean-square error (nm)", true, {}};
  panel.references = {{io::PlotDirection::horizontal,
                       off_in_place(reconstruction::eroded(s.afm, 0), s),
                       "scan eroded by the true tip, at its true place"}};
  const auto point = [&](const char* name, double from, double off) {
    panel.series.push_back({name, {from}, {off}, {}, io::PlotStyle::points});
    fmt::print("{}: {}: {:.1f} s, {:.2f} nm\n", panel.title, name, from, off);
    std::fflush(stdout);
  };
  const auto timed = [&] {
    const auto begin = std::chrono::steady_clock::now();
    workflow::ReconstructSummary r = workflow::run(job);
    return std::pair(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
        std::move(r));
  };
  const auto [alone, scan] = timed();
  point("scan alone, placed by the truth", alone, off_in_place(scan.result.surface, s));
  job.sem.emplace();
  job.sem->image = s.sem.image;
  job.model.file = model;
  job.truth = s.truth;
  for (const int corrections : {0, workflow::ReconstructJob().corrections}) {
    job.corrections = corrections;
    const auto [seconds, both] = timed();
    if (both.truth)
      point(corrections == 0 ? "both images" : "both, the model corrected", seconds,
            both.truth->rms_nm);
  }
  return panel;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(
        stderr,
        "bench_coverage MODEL.json [--without-corrections [--model-error SHARE] | --foretell "
        "| --chart CHART.svg] FOLDER ...\n");
    return 2;
  }
  if (std::string(argv[2]) == "--foretell") {
    for (int i = 3; i < argc; ++i) foretell(argv[1], argv[i]);
    return 0;
  }
  if (std::string(argv[2]) == "--chart" && argc > 4) {
    io::Plot plot;
    plot.title = "Reconstruction, nothing told: error against time";
    for (int i = 4; i < argc; ++i) plot.panels.push_back(panel_of(argv[1], argv[i]));
    io::write_plot(argv[3], plot);
    return 0;
  }
  std::map<std::string, Pooled> pooled;
  const bool fast = std::string(argv[2]) == "--without-corrections";
  const int corrections = fast ? 0 : workflow::ReconstructJob().corrections;
  int first = fast ? 3 : 2;
  double model_error = workflow::ReconstructJob().model_error;
  if (first + 1 < argc && std::string(argv[first]) == "--model-error")
    model_error = std::stod(argv[first + 1]), first += 2;
  for (int i = first; i < argc; ++i) judge(argv[1], argv[i], corrections, model_error, pooled);
  fmt::print("pooled\n");
  for (const auto& [region, p] : pooled)
    fmt::print("  {:9} within one {:5.1f} %, two {:5.1f} %, interval {:5.1f} %\n", region,
               100 * p.one / p.pixels, 100 * p.two / p.pixels, 100 * p.interval / p.pixels);
}
