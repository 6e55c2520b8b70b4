// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bound_parameters.h"
#include "surf/workflow/register_job.h"

namespace surf::cli {

/// What `register` and `reconstruct` are told about their inputs and how these come to lie on each other, as text.
struct ChainOptions {
  std::string afm, sem;   ///< files
  BoundParameters bound;   ///< of how the scan is read and levelled
  std::optional<std::string> sem_channel, sem_pixel_size;
  std::optional<std::string> tip, tip_size, afm_noise, seed;
  std::optional<std::string> material, energy, spot, model, cache;
  std::vector<std::string> materials;
  std::optional<std::string> landmarks, objective, threads;
  bool no_level = false, landmarks_only = false, quiet = false;
};

// Each adds a group of options.
void add_chain_inputs(CLI::App& app, ChainOptions& options);
void add_preparation_options(CLI::App& app, ChainOptions& options);
void add_model_request(CLI::App& app, ChainOptions& options);
void add_pose_options(CLI::App& app, ChainOptions& options);

// Text to what the jobs take. Inputs are read, with a note of what had to be assumed unless `quiet`. All throw
// UsageError, FileError and InvalidInput.
workflow::AfmInput read_afm(const ChainOptions& options);
workflow::SemInput read_sem(const ChainOptions& options);
workflow::ModelRequest model_request(const ChainOptions& options);
/// `afm` and `sem` say where the pixels of landmarks are.
workflow::PoseOptions pose_options(const ChainOptions& options, const HeightField& afm, const PlacedImage& sem);

/// Of what changes the inputs: option and value in turn, as the repeating command needs them.
std::vector<std::string> input_words(const ChainOptions& options);

/// A map for people: rotation, scales, shear, shift, and one line each for what a registration found.
void print_pose(const workflow::Pose& pose, double sem_pixel_nm);

}  // namespace surf::cli
