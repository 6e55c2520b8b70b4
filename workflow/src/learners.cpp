// SPDX-License-Identifier: GPL-3.0-or-later
#include "learners.h"

#include <fmt/format.h>

#include "surf/core/error.h"

namespace surf::workflow {
namespace {

constexpr const Learner* all[] = {&filter_bank_learner, &secant_learner, &ikeuchi_exponential_learner,
                                  &ikeuchi_secant_learner, &ikeuchi_mixed_learner};

// Of a filter bank, which a kind that takes none of them must refuse.
void refuse_options(const LearnOptions& o) {
  const char* const given = !o.scales.empty() ? "--scales" : o.multi_resolution ? "--multi-resolution"
                            : o.cut_off ? "--cut-off" : nullptr;
  if (given)
    throw UsageError(given, fmt::format("a model '{}' has none", o.kind), "Leave it out, or add --model filter-bank");
}

}  // namespace

const Learner& learner_of(const LearnOptions& options) {
  std::string names;
  for (const Learner* learner : all) {
    if (options.kind == learner->name) {
      learner->check ? learner->check(options) : refuse_options(options);
      return *learner;
    }
    names += fmt::format("{}{}", names.empty() ? "" : ", ", learner->name);
  }
  throw UsageError("--model", fmt::format("there is no kind '{}'", options.kind), fmt::format("Choose one of {}", names));
}

std::span<const Learner* const> learners() { return all; }

std::vector<LearnableKind> learnable_kinds() {
  std::vector<LearnableKind> kinds;
  for (const Learner* learner : all) kinds.push_back({learner->name, learner->what});
  return kinds;
}

}  // namespace surf::workflow
