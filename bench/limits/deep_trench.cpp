// SPDX-License-Identifier: GPL-3.0-or-later
// The bottom of an ever deeper trench, which few BSE leave: whether the pilot of --accuracy, 24
// primaries, still finds how many electrons it takes. 16 pixels along it, all alike, with four
// libraries, so that their scatter is the true error.
#include "simulations.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

constexpr double width_nm = 20, accuracy = 0.2;
constexpr int pixels = 16, seeds = 4;

mc::Scene trench(double depth_nm) {
  mc::Specimen s = bench::flat(bench::only_silicon());
  if (depth_nm > 0) {
    s.bodies.push_back({"left", make_box({-200, -400, 0}, {-width_nm / 2, 400, depth_nm}), 0});
    s.bodies.push_back({"right", make_box({width_nm / 2, -400, 0}, {200, 400, depth_nm}), 0});
  }
  mc::Scan scan;
  scan.width = 1;
  scan.height = pixels;
  scan.pixel_x_nm = scan.pixel_y_nm = 2;
  return mc::Scene(s, bench::beam(300), scan);
}

std::vector<double> at(double depth_over_width) {
  const mc::Scene scene = trench(depth_over_width * width_nm);
  const mc::Estimate truth = mean_yield(simulate(scene, mc::Method::direct, 5000, 17), bse);
  mc::SimulationOptions options;
  options.budget = mc::Accuracy{accuracy, 0.01};
  const double asked = std::max(accuracy * truth.mean, mc::floor_of(options.budget));
  std::vector<double> row{truth.mean, truth.standard_error, asked};
  for (const mc::Method method : {mc::Method::direct, mc::Method::replay}) {
    options.method = method;
    double sum = 0, squares = 0, primaries = 0, missed = 0;
    for (int seed = 1; seed <= seeds; ++seed) {  // each with a library of its own
      options.seed = static_cast<std::uint64_t>(seed);
      const mc::SimulationResult r = mc::simulate(scene, options, {.libraries = &cascades()});
      const mc::ResultSummary summary = mc::summarize(r);
      primaries += summary.mean_electrons / seeds;
      missed += static_cast<double>(summary.missed);
      for (int y = 0; y < pixels; ++y) {
        const double off = (r.yield(bse, 0, y).mean - truth.mean) / asked;
        sum += off / (seeds * pixels);
        squares += off * off / (seeds * pixels);
      }
    }
    row.insert(row.end(), {sum, std::sqrt(squares), primaries, missed});
  }
  return row;
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "BSE from the bottom of a trench, --accuracy 20%, silicon, 300 eV";
  const io::PlotAxis x{"depth over width", false, {}};
  out.panels = {panel(t, "", x, {"error of 64 pixels, in errors asked for", false, {}},
                      {{"direct_rms", "rms, direct"},
                       {"replay_rms", "rms, replay", true},
                       {"direct_bias", "mean, direct"},
                       {"replay_bias", "mean, replay", true}}),
                panel(t, "", x, {"primaries of a pixel", true, {}},
                      {{"direct_primaries", "direct"}, {"replay_primaries", "replay", true}})};
  out.panels[0].references = {{io::PlotDirection::horizontal, 1, "as asked for"}};
  out.columns = 2;
  return out;
}

}  // namespace

Sweep deep_trench() {
  return {"deep_trench",
          "what --accuracy reaches where signals are rare",
          {"depth_over_width", "bse", "bse_error", "asked", "direct_bias", "direct_rms",
           "direct_primaries", "direct_missed", "replay_bias", "replay_rms", "replay_primaries",
           "replay_missed"},
          {0, 0.5, 1, 2, 3, 5},
          at,
          2,
          1e-6,
          plot};
}

}  // namespace surf::limits
