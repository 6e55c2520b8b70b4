// SPDX-License-Identifier: GPL-3.0-or-later
#include "learners.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "surf/core/error.h"

namespace surf::workflow {
namespace {

constexpr const Learner* all[] = {&facet_network_learner,   &filter_bank_learner,
                                  &slope_table_learner,     &slope_table_two_planes_learner,
                                  &stopping_points_learner, &diffusion_matrix_learner,
                                  &secant_learner,          &ikeuchi_exponential_learner,
                                  &ikeuchi_secant_learner,  &ikeuchi_mixed_learner};

bool takes(const Learner& learner, std::string_view field) {
  return std::ranges::find(learner.fields, field) != learner.fields.end();
}

void refuse_options(const Learner& learner, const LearnOptions& o) {
  const std::pair<bool, const char*> fields[] = {
      {!o.scales.empty(), "scales"},
      {o.multi_resolution, "multi_resolution"},
      {o.least_eigenvalue.has_value(), "least_eigenvalue"},
      {o.hidden.has_value(), "hidden"},
      {o.iterations.has_value(), "iterations"},
      {o.decay.has_value(), "decay"},
      {o.model_error.has_value(), "model_error"},
      {o.table_electrons.has_value(), "table_electrons"}};
  for (const auto& [given, field] : fields) {
    if (!given || takes(learner, field)) continue;
    const auto other =
        std::ranges::find_if(all, [&](const Learner* l) { return takes(*l, field); });
    throw UsageError(fmt::format("`training.{}`", field),
                     fmt::format("a model '{}' has none", learner.name),
                     fmt::format("Leave it out, or add `training.kind={}`", (*other)->name));
  }
}

void refuse_sides(const Learner& learner, const TrainJob& job) {
  if (learner.knows_sides) return;
  for (const mc::Detector& d : job.detectors)
    if (mc::looks_from_a_side(d))
      throw UsageError(
          "`simulation.detectors`",
          fmt::format("{} looks from a side, and a model '{}' gives flanks that face left and "
                      "right the same",
                      d.name, learner.name),
          fmt::format("Leave it out, or add `training.kind={}`", facet_network_learner.name));
}

// Refuses options that only apply to training from images.
void refuse_learning_from_images(const Learner& learner, const TrainJob& job) {
  if (!job.detectors.empty())
    throw UsageError(
        "`simulation.detectors`", fmt::format("a model '{}' gives SE and BSE only", learner.name),
        fmt::format("Leave it out, or add `training.kind={}`", facet_network_learner.name));
  if (job.held_out > 0)
    throw UsageError(
        "`training.hold_out`",
        fmt::format("a model '{}' learns from no surface: all of them only judge it", learner.name),
        "Leave it out");
  if (!job.signal.empty())
    throw UsageError(
        "`training.signal`",
        fmt::format("a model '{}' gives SE and BSE, not what a microscope makes of them",
                    learner.name),
        "Leave it out; 'semsurf calibrate' compares the two");
}

}  // namespace

const Learner& learner_of(const TrainJob& job) {
  std::string names;
  for (const Learner* learner : all) {
    if (job.learn.kind == learner->name) {
      check_parameters(job);
      refuse_options(*learner, job.learn);
      if (!learner->needs_images) refuse_learning_from_images(*learner, job);
      refuse_sides(*learner, job);
      if (learner->check) learner->check(job);
      return *learner;
    }
    names += fmt::format("{}{}", names.empty() ? "" : ", ", learner->name);
  }
  throw UsageError("`training.kind`", fmt::format("there is no kind '{}'", job.learn.kind),
                   fmt::format("Choose one of {}", names));
}

std::span<const Learner* const> learners() { return all; }

std::vector<LearnableKind> learnable_kinds() {
  std::vector<LearnableKind> kinds;
  for (const Learner* learner : all)
    kinds.push_back({learner->name, learner->what, learner->needs_images});
  return kinds;
}

}  // namespace surf::workflow
