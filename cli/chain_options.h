// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bound_parameters.h"
#include "surf/io/sim/materials.h"
#include "surf/workflow/register_job.h"

namespace surf::cli {

/// Files that `register` and `reconstruct` read, and what the specimen is made of.
struct ChainFiles {
  std::string afm, landmarks, tip;
  std::vector<std::string> sem;
  io::MaterialChoice material;
};
void describe(ParameterVisitor& visit, ChainFiles& files);

/// What `register` and `reconstruct` are told about their inputs and how these come to lie on each
/// other.
struct ChainOptions {
  BoundParameters bound;
  std::optional<std::string> afm_noise;  ///< as it was said before: ALPHA,INNOVATION
  bool no_level = false, quiet = false;
};

/// How both commands call and group parameters, and hidden options of before.
void add_chain_options(CLI::App& app, ChainOptions& options);

// What a described job cannot be told by text alone. Inputs are read, with a note of what had to be
// assumed unless `quiet`. All throw UsageError, FileError and InvalidInput.
void take_afm(const ChainOptions& options, const ChainFiles& files, workflow::AfmInput& afm);
/// FILE or FILE:CHANNEL.
void take_sem(const ChainOptions& options, const std::string& file, workflow::SemInput& sem);
void take_model(const ChainOptions& options, const ChainFiles& files, int threads,
                workflow::ModelRequest& model);
/// `afm` and `sem` say where the pixels of landmarks are.
void take_pose(const ChainOptions& options, const ChainFiles& files, const HeightField& afm,
               const PlacedImage& sem, workflow::PoseOptions& pose);

/// A map for people: rotation, scales, shear, shift, and one line each for what a registration
/// found.
void print_pose(const workflow::Pose& pose, double sem_pixel_nm);

}  // namespace surf::cli
