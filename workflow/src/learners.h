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

/// The input of the training of a model.
struct Lesson {
  const TrainJob& job;
  ModelScope scope;
  std::vector<std::string> channels;
  /// Without those held out; empty for kinds that need no images.
  const std::vector<TrainingImage>& images;
  const Reporter& reporter;

  /// Progress of the whole training.
  Watch watch() const { return reporter.watch(); }
};

struct Learnt {
  decltype(TrainedModel::parameters) parameters;
  double condition_number = 0;  ///< 0: no equations were solved
  std::vector<std::string> warnings;
  std::map<std::string, std::string> notes;
};

/// How one kind of model is trained.
struct Learner {
  const char* name;
  const char* what;
  /// The fields of LearnOptions that apply to this kind. Others are refused.
  std::vector<std::string_view> fields;
  /// Throws UsageError for values out of range and combinations that this kind does not support,
  /// before any time is spent. Null: nothing is checked.
  void (*check)(const TrainJob& job);
  Learnt (*learn)(const Lesson& lesson);  ///< throws Interrupted
  bool needs_images = true;
  bool knows_sides = false;  ///< it can learn detectors that look from a side
};

// A new kind needs a source file, a line here and a line in learners.cpp.
extern const Learner facet_network_learner, filter_bank_learner;
extern const Learner secant_learner, ikeuchi_exponential_learner, ikeuchi_secant_learner,
    ikeuchi_mixed_learner;
extern const Learner slope_table_learner, slope_table_two_planes_learner;
extern const Learner stopping_points_learner, diffusion_matrix_learner;

/// Finds the learner of a job. Throws UsageError for an unknown kind, listing all kinds, and for
/// options that do not apply to the kind.
const Learner& learner_of(const TrainJob& job);

std::span<const Learner* const> learners();

}  // namespace surf::workflow
