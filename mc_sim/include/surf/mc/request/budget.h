// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

namespace surf {
class ParameterVisitor;
}

namespace surf::mc {

/// Each pixel gets as many primaries.
struct ElectronsPerPixel {
  std::int64_t count = 200;  ///< 1 to 2^31
};

/// Each pixel gets a number of its own, drawn from the Poisson distribution, as in a microscope.
struct Dose {
  double electrons = 0;                 ///< the mean number of primaries of a pixel, above 0 to 1e9
  double current_pa = 0, dwell_us = 0;  ///< of the probe, where they make the dose
};

/// Current and dwell time, both above 0, to the mean number of primaries.
Dose dose_of_probe(double current_pa, double dwell_us);

/// Each pixel gets as many primaries as it takes to bring the standard error of every detector
/// down.
struct Accuracy {
  double share = 0.01;   ///< standard error over the pixel's mean, 1e-4 to 1
  double floor = 0.002;  ///< no standard error below this is asked for, >= 0, per primary
};

/// The accuracy that fits in this wall time. Jobs find it; the simulator itself takes the others.
struct TimeLimit {
  double seconds = 30;   ///< above 0
  double floor = 0.002;  ///< as of Accuracy
};

/// How much is simulated: one of these.
using Budget = std::variant<ElectronsPerPixel, Dose, Accuracy, TimeLimit>;

// 0 where the budget is another.
std::int64_t electrons_of(const Budget& budget);
double dose_of(const Budget& budget);
double accuracy_of(const Budget& budget);
double floor_of(const Budget& budget);
/// The number of a pixel, or its mean.
double mean_electrons_of(const Budget& budget);

/// A budget as people say it: scene files, command lines, sweeps. What is not said is absent.
struct BudgetWords {
  std::optional<std::int64_t> electrons;
  std::optional<double> accuracy, accuracy_floor, time_s, current_pa, dwell_us;
};

void describe(ParameterVisitor& visit, BudgetWords& words);

/// What is said as a budget, in place of `usual`, which holds where nothing is. Throws UsageError
/// for two ways at once, one of current and dwell time alone, and a floor without an accuracy.
Budget budget_of(const BudgetWords& words, const Budget& usual = ElectronsPerPixel{});

/// The same budget in words.
BudgetWords words_of(const Budget& budget);

/// Throws UsageError for numbers out of range.
void validate(const Budget& budget);

}  // namespace surf::mc
