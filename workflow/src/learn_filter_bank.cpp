// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "learners.h"
#include "surf/core/units.h"
#include "surf/sem/fit_filter_bank.h"

namespace surf::workflow {
namespace {

Learnt learn(const Lesson& lesson) {
  const LearnOptions& o = lesson.job.learn;
  FilterBankFitOptions options;
  if (!o.scales.empty()) options.scales = o.scales;
  options.multi_resolution = o.multi_resolution;
  if (o.least_eigenvalue) options.eigenvalue_cutoff = *o.least_eigenvalue;
  options.threads = lesson.job.simulation.threads;
  FilterBankFit fit = fit_filter_bank(lesson.images, lesson.channels, options);
  return {std::move(fit.parameters),
          fit.condition_number,
          std::move(fit.warnings),
          {{"least_eigenvalue", format_exact(options.eigenvalue_cutoff)},
           {"components", fmt::format("{} of {}", fit.components, fit.eigenvalues.size())},
           {"eigenvalues", fmt::format("{:.4g}", fmt::join(fit.eigenvalues, ", "))}}};
}

}  // namespace

const Learner filter_bank_learner{
    "filter-bank",
    "gradient and curvatures at ten scales, combined (thesis, chapter 6)",
    {"scales", "multi_resolution", "least_eigenvalue"},
    nullptr,
    learn};

}  // namespace surf::workflow
