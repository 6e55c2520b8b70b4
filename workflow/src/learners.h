// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "surf/sem/training_image.h"
#include "surf/workflow/train_job.h"

namespace surf::workflow {

/// What there is to learn from.
struct Lesson {
  const TrainJob& job;
  ModelScope scope;
  std::vector<std::string> channels;
  const std::vector<TrainingImage>& images;   ///< at least one; those held out are not among them
  const TrainListener& listener;
};

struct Learnt {
  decltype(TrainedModel::parameters) parameters;
  double condition_number = 0;                ///< 0: none was solved
  std::vector<std::string> warnings;
  std::map<std::string, std::string> notes;
};

/// How one kind of model is learnt.
struct Learner {
  const char* name;
  const char* what;
  /// Throws UsageError for options that do not concern the kind or are out of range: before any time is
  /// spent. Null: none of LearnOptions concern it.
  void (*check)(const LearnOptions& options);
  Learnt (*learn)(const Lesson& lesson);
};

// A new kind: its source file, a line here and one in learners.cpp.
extern const Learner filter_bank_learner;
extern const Learner secant_learner, ikeuchi_exponential_learner, ikeuchi_secant_learner, ikeuchi_mixed_learner;

/// Throws UsageError, naming all, for a kind that is not known or options that do not concern it.
const Learner& learner_of(const LearnOptions& options);

std::span<const Learner* const> learners();

}  // namespace surf::workflow
