// SPDX-License-Identifier: GPL-3.0-or-later
// Flat silicon in ever larger images: which method is chosen, and what the other one would have
// saved, in work.
#include <algorithm>

#include "simulations.h"
#include "surf/mc/sampling/choose_method.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

// What a segment of a library costs to make, in steps of direct simulation: measured, 1.1 to 2.4
// (choose_method.cpp). The choice itself counts with a saving, too.
constexpr double cheap = 1.1, usual = 1.7, dear = 2.4;

struct Work {
  double direct, replay;  // steps of a primary
  double segments;        // of a cascade
};

const Work& work() {
  static const Work counted = [] {
    const mc::Scene scene(bench::flat(bench::only_silicon()), bench::beam(300),
                          bench::view(100, 8));
    const auto steps = [&](mc::Method method) {
      const mc::Balance b = simulate(scene, method, 50).balance;
      return static_cast<double>(b.steps) / static_cast<double>(b.incident);
    };
    // A library of one page: all are alike.
    mc::CascadeLibrary library(
        {scene.materials()[0], scene.physics(),
         300 + mc::make_medium(scene.materials()[0], scene.physics()).barrier_ev(), 1});
    library.grow(1, 0);
    return Work{steps(mc::Method::direct), steps(mc::Method::replay),
                mc::describe(library, 500).segments_per_cascade};
  }();
  return counted;
}

std::vector<double> at(double across) {
  const mc::Scene scene(bench::flat(bench::only_silicon()), bench::beam(300),
                        bench::view(100, static_cast<int>(across)));
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{50};
  const mc::MethodChoice choice = mc::choose_method(scene, options);
  const double primaries = across * across * 50;
  const double direct = primaries * work().direct;
  const auto regret = [&](double of_a_segment) {
    const double replay = primaries * work().replay +
                          of_a_segment * work().segments * static_cast<double>(choice.cascades);
    return (choice.method == mc::Method::replay ? replay : direct) / std::min(replay, direct);
  };
  return {choice.method == mc::Method::replay ? 1.0 : 0.0,
          direct,
          primaries * work().replay,
          usual * work().segments * static_cast<double>(choice.cascades),
          regret(cheap),
          regret(usual),
          regret(dear)};
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "Direct or replay, flat silicon at 300 eV, 50 electrons per pixel";
  const io::PlotAxis x{"pixels across", true, {}};
  out.panels = {panel(t, "", x, {"steps", true, {}},
                      {{"direct_steps", "direct"},
                       {"making_steps", "making the library", true},
                       {"replay_steps", "replaying it"}}),
                panel(t, "", x, {"work of the choice over the lesser", false, {}},
                      {{"regret_cheap", "a segment costs 1.1 steps"},
                       {"regret", "1.7"},
                       {"regret_dear", "2.4"}})};
  const std::vector<double> size = t.column("pixels_across"), replay = t.column("replay_chosen");
  for (std::size_t i = 1; i < size.size(); ++i)
    if (replay[i] > replay[i - 1])
      for (io::PlotPanel& p : out.panels)
        p.references = {{io::PlotDirection::vertical, std::sqrt(size[i] * size[i - 1]),
                         "replay is chosen from here"}};
  out.columns = 2;
  return out;
}

}  // namespace

Sweep choice_of_method() {
  return {"choice_of_method",
          "the work of the method chosen against the other's, by the size of the image",
          {"pixels_across", "replay_chosen", "direct_steps", "replay_steps", "making_steps",
           "regret_cheap", "regret", "regret_dear"},
          {4, 8, 12, 16, 20, 24, 28, 32, 40, 64, 128, 256},
          at,
          24,
          1e-6,
          plot};
}

}  // namespace surf::limits
