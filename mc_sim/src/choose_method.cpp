// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/choose_method.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/mc/cascade_library.h"

namespace surf::mc {

namespace {

// Measured (bench_library, bench_replay), by beam energy in eV. Bytes are the mean of carbon, silicon
// and gold; the work of making a cascade is in direct primaries, which are given up early where they
// cannot reach a surface any more: the higher the energy, the earlier.
struct AtEnergy {
  double energy_ev, bytes, direct_primaries;
};
constexpr std::array<AtEnergy, 5> measured{{{500, 6e3, 4},
                                            {1000, 13e3, 6},
                                            {3000, 40e3, 10},
                                            {10000, 130e3, 20},
                                            {30000, 400e3, 30}}};

// What replay saves of a primary's work, at least.
constexpr double saved = 0.5;

double at_energy(double energy_ev, double AtEnergy::*value) {
  const double e = std::log(energy_ev);
  std::size_t i = 1;
  while (i + 1 < measured.size() && energy_ev > measured[i].energy_ev) ++i;
  const AtEnergy &a = measured[i - 1], &b = measured[i];
  const double t = (e - std::log(a.energy_ev)) / (std::log(b.energy_ev) - std::log(a.energy_ev));
  return std::exp(std::log(a.*value) + t * (std::log(b.*value) - std::log(a.*value)));
}

std::string count(double n) {
  if (n < 1e3) return fmt::format("{:.0f}", n);
  if (n < 1e6) return fmt::format("{:.3g} thousand", n / 1e3);
  return fmt::format("{:.3g} million", n / 1e6);
}

// What a pixel gets at most: with a dose, numbers scatter about it.
std::int64_t most_primaries(const SimulationOptions& o) {
  if (o.dose > 0) return static_cast<std::int64_t>(std::ceil(o.dose + 6 * std::sqrt(o.dose) + 6));
  return o.electrons;
}

struct Obstacle {
  std::string reason, remedy;
};

// Why replay cannot serve at all, if it cannot.
std::optional<Obstacle> obstacle(const Scene& scene, const MethodChoice& choice,
                                 const SimulationOptions& options, const MethodLimits& limits) {
  if (limits.observed)
    return Obstacle{"deposited energy needs every electron's whole track, which stored cascades do "
                    "not show", "Leave out --deposit"};
  if (!can_replay(scene.physics()))
    return Obstacle{"without continuous loss there is no energy at which cascades could be joined",
                    "Use loss=joy-luo"};
  if (choice.library_bytes <= limits.library_bytes) return std::nullopt;
  return Obstacle{
      fmt::format("{} cascades of {} at {:g} keV take about {:.2g} GB of memory, more than {:.2g}",
                  choice.cascades,
                  scene.materials().size() == 1
                      ? "one material" : fmt::format("each of {} materials", scene.materials().size()),
                  scene.beam().energy_ev / 1e3, choice.library_bytes / 1e9,
                  limits.library_bytes / 1e9),
      options.accuracy > 0 ? "Ask for less accuracy, or a lower --energy"
                           : "Ask for fewer electrons per pixel, or a lower --energy"};
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

double cascade_bytes(double beam_energy_ev) { return at_energy(beam_energy_ev, &AtEnergy::bytes); }

MethodChoice choose_method(const Scene& scene, const SimulationOptions& options,
                           std::optional<Method> asked, const MethodLimits& limits) {
  const double energy = scene.beam().energy_ev;
  const auto materials = static_cast<double>(scene.materials().size());
  MethodChoice choice;
  choice.cascades = library_size(options, most_primaries(options));
  choice.library_bytes = materials * static_cast<double>(choice.cascades) * cascade_bytes(energy);

  if (asked == Method::direct) {
    if (options.accuracy > 0)
      throw UsageError("--method direct", "only replay can go on until an accuracy is reached",
                       "Leave out --method, or give --electrons instead of the accuracy");
    choice.reason = "as asked for";
    return choice;
  }
  const auto no_replay = obstacle(scene, choice, options, limits);
  if (no_replay && (asked || options.accuracy > 0))
    throw UsageError(asked ? "--method replay" : "--accuracy",
                     (asked ? "" : "it takes replay, but ") + no_replay->reason, no_replay->remedy);
  if (no_replay) {
    choice.reason = no_replay->reason;
    return choice;
  }
  if (asked || options.accuracy > 0) {
    choice.method = Method::replay;
    choice.reason = asked ? "as asked for" : "the one that can go on until an accuracy is reached";
    return choice;
  }
  const double primaries = (options.dose > 0 ? options.dose : static_cast<double>(options.electrons)) *
                           static_cast<double>(scene.scan().width) *
                           static_cast<double>(scene.scan().height);
  const double making = materials * static_cast<double>(choice.cascades) *
                        at_energy(energy, &AtEnergy::direct_primaries);
  const bool pays = making < saved * primaries;
  choice.method = pays ? Method::replay : Method::direct;
  choice.reason =
      pays ? fmt::format("{} primaries share {} cascades{}", count(primaries),
                         count(static_cast<double>(choice.cascades)),
                         materials > 1 ? " of each material" : "")
           : fmt::format("{} primaries are too few to make {} cascades for{}", count(primaries),
                         count(static_cast<double>(choice.cascades)),
                         materials > 1 ? fmt::format(" in each of {} materials", materials) : "");
  return choice;
}

}  // namespace surf::mc
