// SPDX-License-Identifier: GPL-3.0-or-later
// --accuracy of a detector that few electrons reach, with libraries that may take no more than 40
// MB: what is asked for, what is reached, and what the program does. (The program's own limit is 2
// GiB.)
#include <algorithm>

#include "simulations.h"
#include "surf/mc/sampling/choose_method.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

constexpr double memory = 40e6;

std::vector<double> at(double asked_percent) {
  const mc::Scene scene(bench::flat(bench::only_silicon()), bench::beam(300), bench::view(100, 2));
  mc::SimulationOptions options;
  options.method = mc::Method::replay;
  options.budget = mc::Accuracy{asked_percent / 100, 0};
  options.library_memory = memory;
  mc::Detector narrow;
  narrow.name = "narrow";
  narrow.min_energy_ev = 50;
  narrow.max_angle_deg = 20;
  options.detectors = {narrow};
  mc::MethodLimits limits;
  limits.library_bytes = memory;
  const mc::MethodChoice choice = mc::choose_method(scene, options, {}, limits);
  // The least library grows beyond the memory: the program goes on directly, and so does this.
  const bool fits = choice.library_bytes <= memory;
  if (!fits)
    return {0, static_cast<double>(choice.cascades), choice.library_bytes / 1e6, none, none, none};
  const mc::SimulationResult r = mc::simulate(scene, options, {.libraries = &cascades()});
  const mc::ResultSummary s = mc::summarize(r);
  return {1,
          static_cast<double>(r.library_cascades),
          choice.library_bytes / 1e6,
          asked_percent * s.worst,
          static_cast<double>(s.missed) / static_cast<double>(s.seen),
          s.missed > 0 ? 1.0 : 0.0};
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "Accuracy of a narrow detector, libraries of 40 MB at most";
  const io::PlotAxis x{"standard error asked for (%)", true, {}};
  io::PlotPanel reached = panel(t, "", x, {"standard error reached, worst pixel (%)", true, {}},
                                {{"reached_percent", "by replay"}});
  io::PlotSeries asked;
  asked.name = "as asked for";
  asked.x = asked.y = t.column("asked_percent");
  asked.dashed = true;
  reached.series.push_back(asked);
  out.panels = {std::move(reached), panel(t, "what the program does", x,
                                          {"1: yes", false, io::PlotAxis::Range{-0.1, 1.3}},
                                          {{"replay", "the library fits: replay is possible"},
                                           {"warned", "replay: warning and exit code 4", true}})};
  out.columns = 2;
  return out;
}

}  // namespace

Sweep accuracy_memory() {
  return {"accuracy_memory",
          "an accuracy of 30 to 1 % where libraries may not grow",
          {"asked_percent", "replay", "cascades", "least_library_mb", "reached_percent",
           "missed_share", "warned"},
          {30, 20, 10, 8, 6, 5, 4, 3.5, 3, 2, 1},
          at,
          4,
          1e-6,
          plot};
}

}  // namespace surf::limits
