// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "surf/sem/training_image.h"
#include "surf/workflow/train_job.h"

namespace surf::workflow {

/// What there is to learn from.
struct Lesson {
  const TrainJob& job;
  ModelScope scope;
  std::vector<std::string> channels;
  const std::vector<TrainingImage>&
      images;  ///< without those held out; none for kinds that need none
  const Reporter& reporter;

  /// For the whole of learning.
  Watch watch() const { return reporter.watch(); }
};

struct Learnt {
  decltype(TrainedModel::parameters) parameters;
  double condition_number = 0;  ///< 0: none was solved
  std::vector<std::string> warnings;
  std::map<std::string, std::string> notes;
};

/// How one kind of model is learnt.
struct Learner {
  const char* name;
  const char* what;
  /// Which of LearnOptions concern it. Others are refused.
  std::vector<std::string_view> fields;
  /// Throws UsageError for what is out of range or cannot be had with this kind: before any time is
  /// spent. Null: there is no such thing.
  void (*check)(const TrainJob& job);
  Learnt (*learn)(const Lesson& lesson);  ///< throws Interrupted
  bool needs_images = true;
};

// A new kind: its source file, a line here and one in learners.cpp.
extern const Learner facet_network_learner, filter_bank_learner;
extern const Learner secant_learner, ikeuchi_exponential_learner, ikeuchi_secant_learner,
    ikeuchi_mixed_learner;
extern const Learner slope_table_learner, slope_table_two_planes_learner;
extern const Learner stopping_points_learner, diffusion_matrix_learner;

/// Throws UsageError, naming all, for a kind that is not known or what it cannot be learnt with.
const Learner& learner_of(const TrainJob& job);

std::span<const Learner* const> learners();

}  // namespace surf::workflow
