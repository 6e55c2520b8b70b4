// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/request/budget.h"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "surf/core/error.h"
#include "surf/core/parameters.h"
#include "surf/core/units.h"

namespace surf::mc {
namespace {

constexpr double most_electrons = 2147483648.0, largest_dose = 1e9;

/// The ways that are said, under the names of their parameters.
std::vector<const char*> ways(const BudgetWords& words) {
  std::vector<const char*> all;
  for (const auto& [said, name] :
       {std::pair{words.electrons.has_value(), "`simulation.electrons`"},
        {words.accuracy.has_value(), "`simulation.accuracy`"},
        {words.time_s.has_value(), "`simulation.time`"},
        {words.current_pa || words.dwell_us, "`beam.current` and `beam.dwell`"}})
    if (said) all.push_back(name);
  return all;
}

}  // namespace

Dose dose_of_probe(double current_pa, double dwell_us) {
  return {current_pa * dwell_us * electrons_per_pa_us, current_pa, dwell_us};
}

std::int64_t electrons_of(const Budget& budget) {
  const auto* const fixed = std::get_if<ElectronsPerPixel>(&budget);
  return fixed ? fixed->count : 0;
}

double dose_of(const Budget& budget) {
  const auto* const dose = std::get_if<Dose>(&budget);
  return dose ? dose->electrons : 0;
}

double mean_electrons_of(const Budget& budget) {
  return dose_of(budget) > 0 ? dose_of(budget) : static_cast<double>(electrons_of(budget));
}

double accuracy_of(const Budget& budget) {
  const auto* const accuracy = std::get_if<Accuracy>(&budget);
  return accuracy ? accuracy->share : 0;
}

double floor_of(const Budget& budget) {
  if (const auto* const accuracy = std::get_if<Accuracy>(&budget)) return accuracy->floor;
  if (const auto* const limit = std::get_if<TimeLimit>(&budget)) return limit->floor;
  return 0;
}

void describe(ParameterVisitor& visit, BudgetWords& words) {
  visit(words.electrons, {.name = "simulation.electrons",
                          .help = "Primaries per pixel",
                          .limits = within(1, most_electrons),
                          .otherwise = std::to_string(ElectronsPerPixel{}.count)});
  visit(words.accuracy, {.name = "simulation.accuracy",
                         .help = "Standard error of every detector over the pixel's mean, in place "
                                 "of a number of electrons: "
                                 "each pixel gets as many as that takes",
                         .unit = Unit::share,
                         .limits = within(1e-4, 1)});
  visit(words.accuracy_floor,
        {.name = "simulation.accuracy_floor",
         .help = "Standard error below which no accuracy is asked for, counts per primary",
         .limits = at_least(0),
         .otherwise = fmt::format("{}", Accuracy{}.floor),
         .level = Level::advanced});
  visit(words.time_s, {.name = "simulation.time",
                       .help = "Wall time for the whole image, in place of a number of electrons: "
                               "the accuracy that fits is "
                               "found and named, and asking for it gives the same bytes",
                       .unit = Unit::s,
                       .limits = above(0),
                       .recorded = false});
  visit(words.current_pa, {.name = "beam.current",
                           .help = "Current of the probe: with a dwell time, in place of a number "
                                   "of electrons, it makes the shot "
                                   "noise of a microscope, in channels NAME.shot",
                           .unit = Unit::pa,
                           .limits = above(0),
                           .level = Level::advanced});
  visit(words.dwell_us, {.name = "beam.dwell",
                         .help = "Time that the beam spends on a pixel, with a current",
                         .unit = Unit::us,
                         .limits = above(0),
                         .level = Level::advanced});
}

Budget budget_of(const BudgetWords& words, const Budget& usual) {
  const std::vector<const char*> said = ways(words);
  if (said.size() > 1)
    throw UsageError(
        said[0], fmt::format("with {} there are two ways to say how much is simulated", said[1]),
        fmt::format("Leave out {}, or {}", said[0], said[1]));
  if (words.current_pa.has_value() != words.dwell_us.has_value())
    throw UsageError(words.current_pa ? "`beam.current`" : "`beam.dwell`",
                     "the other of the two is missing",
                     "Current and dwell time together make the dose of a pixel: give both");
  Budget budget = usual;
  const double floor = accuracy_of(usual) > 0 || std::holds_alternative<TimeLimit>(usual)
                           ? floor_of(usual)
                           : Accuracy{}.floor;
  if (words.electrons) budget = ElectronsPerPixel{*words.electrons};
  if (words.accuracy) budget = Accuracy{*words.accuracy, floor};
  if (words.time_s) budget = TimeLimit{*words.time_s, floor};
  if (words.current_pa) budget = dose_of_probe(*words.current_pa, *words.dwell_us);
  if (words.accuracy_floor) {
    if (auto* const accuracy = std::get_if<Accuracy>(&budget))
      accuracy->floor = *words.accuracy_floor;
    else if (auto* const limit = std::get_if<TimeLimit>(&budget))
      limit->floor = *words.accuracy_floor;
    else
      throw UsageError("`simulation.accuracy_floor`", "there is no accuracy that it could limit",
                       "Add `simulation.accuracy=1%`, or leave it out");
  }
  return budget;
}

BudgetWords words_of(const Budget& budget) {
  BudgetWords words;
  if (const auto* const fixed = std::get_if<ElectronsPerPixel>(&budget))
    words.electrons = fixed->count;
  if (const auto* const accuracy = std::get_if<Accuracy>(&budget))
    words.accuracy = accuracy->share, words.accuracy_floor = accuracy->floor;
  if (const auto* const limit = std::get_if<TimeLimit>(&budget))
    words.time_s = limit->seconds, words.accuracy_floor = limit->floor;
  if (const auto* const dose = std::get_if<Dose>(&budget); dose && dose->current_pa > 0)
    words.current_pa = dose->current_pa, words.dwell_us = dose->dwell_us;
  return words;
}

void validate(const Budget& budget) {
  check_parameters(words_of(budget));
  const auto* const dose = std::get_if<Dose>(&budget);
  if (dose && !(dose->electrons > 0 && dose->electrons <= largest_dose))
    throw UsageError(
        "`beam.current`",
        fmt::format("{:g} primaries per pixel are not above 0 to 1e9", dose->electrons),
        "Choose another current or dwell time");
}

}  // namespace surf::mc
