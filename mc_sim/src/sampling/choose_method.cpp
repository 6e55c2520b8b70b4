// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/sampling/choose_method.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "cascades/cascade_sample.h"
#include "geometry/scene_impl.h"
#include "sampling/adaptive_sampling.h"
#include "surf/core/error.h"
#include "surf/mc/cascades/cascade_library.h"
#include "surf/mc/cascades/library_size.h"
#include "surf/mc/sampling/simulate_unit.h"

namespace surf::mc {

namespace {

// What a segment of a cascade costs to make, in steps of direct simulation, by the share of a
// primary's work that replay then saves. Measured on flat silicon, the mesa and waves of 25 nm
// radius: 1.1 to 2.4 by 0.60 to 0.97, so 1.5 to 2.5, from 0.5 to 10 keV; 3.7 at 30 keV (choice, in
// bench_replay).
constexpr double making_by_saving = 2.5;

// Primaries of a pixel that foretell how many an accuracy takes.
constexpr std::int64_t tried_for_accuracy = 64;

// How many primaries bring the only pixel of a tally to the wanted accuracy, the pilot's included.
double primaries_needed(const SimulationOptions& options, const UnitTally& tally) {
  const auto n = static_cast<double>(tally.pixels.data().front().primaries);
  double most = fewest_primaries;
  for (const Grid<Counts>& counts : tally.counts) {
    Sample s;
    s.n = n;
    s.sum = static_cast<double>(counts.data().front().sum);
    s.squares = static_cast<double>(counts.data().front().squares);
    const double error = wanted_error(options, s.mean());
    if (error > 0) most = std::max(most, s.variance() / (error * error));
  }
  return pilot_primaries + reserve_of_primaries * most;
}

// What some pixels, spread evenly, tell of direct simulation.
struct DirectWork {
  double steps = 0;      // of a primary, where electrons that cannot reach a surface are given up
  double primaries = 0;  // of a pixel, on average
};

// With a wanted accuracy from the scatter of a few primaries more.
DirectWork direct_work(const Scene& scene, const SimulationOptions& options) {
  constexpr int across = 4;
  const bool accurate = accuracy_of(options.budget) > 0;
  SimulationOptions few;
  few.seed = options.seed;
  few.detectors = options.detectors;
  Balance balance;
  DirectWork work;
  const Scan& scan = scene.scan();
  for (int j = 0; j < across; ++j)
    for (int i = 0; i < across; ++i) {
      const int x = (2 * i + 1) * scan.width / (2 * across);
      const int y = (2 * j + 1) * scan.height / (2 * across);
      const UnitTally tally =
          simulate_unit(scene, few, {x, y, x + 1, y + 1, 0, accurate ? tried_for_accuracy : 4});
      balance += tally.balance;
      if (accurate) work.primaries += primaries_needed(options, tally) / (across * across);
    }
  work.steps = static_cast<double>(balance.steps) / static_cast<double>(balance.incident);
  if (!accurate)
    work.primaries =
        std::max(dose_of(options.budget), static_cast<double>(electrons_of(options.budget)));
  return work;
}

struct LibraryWork {
  double bytes = 0, segments = 0;  // of one cascade of each material
};

double start_energy_ev(const Scene& scene, std::size_t material) {
  return scene.beam().energy_ev + scene.impl().medium_pointers[material]->barrier_ev();
}

LibraryWork library_work(const Scene& scene, const SimulationOptions& options) {
  LibraryWork work;
  for (std::size_t m = 0; m < scene.materials().size(); ++m) {
    if (!can_replay(*scene.impl().medium_pointers[m])) continue;
    const CascadeSample sample = sample_cascades(
        {scene.materials()[m], scene.physics(), start_energy_ev(scene, m), options.seed});
    work.bytes += sample.bytes;
    work.segments += sample.segments;
  }
  return work;
}

std::string count(double n) {
  if (n < 1e3) return fmt::format("{:.0f}", n);
  if (n < 1e6) return fmt::format("{:.3g} thousand", n / 1e3);
  return fmt::format("{:.3g} million", n / 1e6);
}

// What a pixel gets at most: with a dose, numbers scatter about it.
std::int64_t most_primaries(const SimulationOptions& o) {
  if (const double dose = dose_of(o.budget); dose > 0)
    return static_cast<std::int64_t>(std::ceil(dose + 6 * std::sqrt(dose) + 6));
  return electrons_of(o.budget);
}

struct Obstacle {
  std::string reason, remedy;
};

// Why replay cannot serve these physics at all, if it cannot.
std::optional<Obstacle> obstacle(const Scene& scene, const MethodLimits& limits) {
  if (limits.observed)
    return Obstacle{
        "deposited energy needs every electron's whole track, which stored cascades do "
        "not show",
        "Leave out `output.deposit`"};
  if (!can_replay(scene.physics(), scene.materials()))
    return Obstacle{"without continuous loss there is no energy at which cascades could be joined",
                    "Use loss=joy-luo or inelastic=dielectric"};
  return std::nullopt;
}

std::optional<Obstacle> too_large(const Scene& scene, const MethodChoice& choice,
                                  const SimulationOptions& options, const MethodLimits& limits) {
  if (choice.library_bytes <= limits.library_bytes) return std::nullopt;
  return Obstacle{
      fmt::format("{} cascades of {} at {:g} keV take about {:.2g} GB of memory, more than {:.2g}",
                  choice.cascades,
                  scene.materials().size() == 1
                      ? "one material"
                      : fmt::format("each of {} materials", scene.materials().size()),
                  scene.beam().energy_ev / 1e3, choice.library_bytes / 1e9,
                  limits.library_bytes / 1e9),
      accuracy_of(options.budget) > 0
          ? "Ask for less accuracy, or a lower `beam.energy`"
          : "Ask for fewer electrons per pixel, or a lower `beam.energy`"};
}

}  // namespace

const char* name(Method method) { return method == Method::direct ? "direct" : "replay"; }

std::optional<Method> parse_method(std::string_view text, std::string_view subject) {
  if (text == "auto") return std::nullopt;
  if (text == "direct") return Method::direct;
  if (text == "replay") return Method::replay;
  throw UsageError(std::string(subject), fmt::format("'{}' is not a method", text),
                   "Choose auto, direct or replay");
}

MethodChoice choose_method(const Scene& scene, const SimulationOptions& options,
                           std::optional<Method> asked, const MethodLimits& limits) {
  const auto materials = scene.materials().size();
  MethodChoice choice;
  choice.cascades = library_size(options, most_primaries(options));
  if (accuracy_of(options.budget) > 0 && limits.observed)
    throw UsageError(
        "`simulation.accuracy`",
        "deposited energy would be of more primaries in some pixels than in others",
        "Leave out `output.deposit`, or give `simulation.electrons` instead of the accuracy");
  if (asked == Method::direct) {
    choice.reason = "as asked for";
    return choice;
  }
  auto no_replay = obstacle(scene, limits);
  LibraryWork work;
  if (!no_replay) {
    work = library_work(scene, options);
    choice.library_bytes = static_cast<double>(choice.cascades) * work.bytes;
    no_replay = too_large(scene, choice, options, limits);
  }
  if (no_replay && asked)
    throw UsageError("`simulation.method=replay`", no_replay->reason, no_replay->remedy);
  if (no_replay) {
    choice.reason = no_replay->reason;
    return choice;
  }
  if (asked) {
    choice.method = Method::replay;
    choice.reason = "as asked for";
    return choice;
  }
  const DirectWork direct = direct_work(scene, options);
  const double primaries = direct.primaries * static_cast<double>(scene.scan().width) *
                           static_cast<double>(scene.scan().height);
  const bool pays = making_by_saving * work.segments * static_cast<double>(choice.cascades) <
                    primaries * direct.steps;
  choice.method = pays ? Method::replay : Method::direct;
  const std::string these =
      fmt::format("{}{} primaries{}", accuracy_of(options.budget) > 0 ? "about " : "",
                  count(primaries), accuracy_of(options.budget) > 0 ? " for this accuracy" : "");
  const std::string those =
      fmt::format("{} cascades{}", count(static_cast<double>(choice.cascades)),
                  materials > 1 ? " of each material" : "");
  choice.reason = pays ? fmt::format("{} share {}", these, those)
                       : fmt::format("{} are too few for {} to pay off", these, those);
  return choice;
}

}  // namespace surf::mc
