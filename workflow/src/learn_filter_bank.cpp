// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "learners.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/sem/fit_filter_bank.h"

namespace surf::workflow {
namespace {

void check(const TrainJob& job) {
  const LearnOptions& o = job.learn;
  if (o.cut_off && !(*o.cut_off >= 0 && std::isfinite(*o.cut_off)))
    throw UsageError("`training.cut_off`", fmt::format("{} is not a number of 0 or above", *o.cut_off), "Write for example 0.1");
}

Learnt learn(const Lesson& lesson) {
  const LearnOptions& o = lesson.job.learn;
  FilterBankFitOptions options;
  if (!o.scales.empty()) options.scales = o.scales;
  options.multi_resolution = o.multi_resolution;
  if (o.cut_off) options.eigenvalue_cutoff = *o.cut_off;
  options.threads = lesson.job.simulation.threads;
  FilterBankFit fit = fit_filter_bank(lesson.images, lesson.channels, options);
  return {std::move(fit.parameters),
          fit.condition_number,
          std::move(fit.warnings),
          {{"cut_off", format_exact(options.eigenvalue_cutoff)},
           {"components", fmt::format("{} of {}", fit.components, fit.eigenvalues.size())},
           {"eigenvalues", fmt::format("{:.4g}", fmt::join(fit.eigenvalues, ", "))}}};
}

}  // namespace

const Learner filter_bank_learner{"filter-bank", "gradient and curvatures at ten scales, combined (thesis, chapter 6)",
                                  {"scales", "multi_resolution", "cut_off"}, check, learn};

}  // namespace surf::workflow
