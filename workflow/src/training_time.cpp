// SPDX-License-Identifier: GPL-3.0-or-later
#include "training_time.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "learners.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "surf/sem/fit_facet_network.h"
#include "training_data.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t timed_images = 4;  // one may take three times as long as another
constexpr int few_steps = 2, more_steps = 8;

template <class Work>
double seconds_of(const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::size_t images_in(const fs::path& folder) {
  std::size_t count = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    count += entry.path().extension() == ".exr";
  return count;
}

/// A step takes as long as the thread with the most images.
double share_of_threads(std::size_t images, int threads) {
  return std::ceil(static_cast<double>(images) / resolve_threads(threads));
}

double learning_s(const TrainJob& job, const Learner& learner,
                  const std::vector<TrainingImage>& images, std::size_t all,
                  const Reporter& reporter) {
  Reporter silent;
  silent.cancel = reporter.cancel;
  TrainJob timed = job;
  const auto learn = [&] {
    const ModelScope scope{job.pixel_nm, job.material.name, job.energy_ev, job.spot_nm};
    return seconds_of([&] { learner.learn({timed, scope, channels_of(job), images, silent}); });
  };
  const auto steps = [&](int count) {
    timed.learn.iterations = count;
    return learn();
  };
  const double more = share_of_threads(all, job.simulation.threads) /
                      share_of_threads(images.size(), job.simulation.threads);
  if (std::ranges::find(learner.fields, "iterations") == learner.fields.end())
    return more * learn();
  const double few = steps(few_steps),
               step = std::max(0.0, steps(more_steps) - few) / (more_steps - few_steps);
  return more * (few + step * job.learn.iterations.value_or(FacetNetworkFitOptions().iterations));
}

}  // namespace

double expected_training_s(const TrainJob& job, const Reporter& reporter) {
  const Learner& learner = learner_of(job);
  std::vector<TrainingSurface> surfaces =
      gather_surfaces(job, own_surfaces(job, learner.needs_images), {});
  const std::size_t all = surfaces.size(), there = images_in(image_folder(job));
  if (all == 0) return 0;
  surfaces.resize(std::min(all, there + timed_images));
  SimulatedImages made;
  const double seconds = seconds_of([&] { made = simulate_images(job, surfaces, reporter); });
  if (!made.runs.complete) throw Interrupted();
  const auto found = static_cast<std::size_t>(made.found);
  double expected = made.made > 0 ? seconds / made.made * static_cast<double>(all - found) : 0;
  if (!learner.needs_images) return expected;
  const std::size_t first = surfaces.size() - std::min(surfaces.size(), timed_images);
  std::vector<TrainingImage> images;
  for (std::size_t i = first; i < surfaces.size(); ++i)
    images.push_back(read_training_image(surfaces[i], made.files[i], job));
  return expected + learning_s(job, learner, images, all, reporter);
}

}  // namespace surf::workflow
