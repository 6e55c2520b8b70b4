// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "surf/core/height_field.h"
#include "surf/core/image.h"
#include "surf/core/parameters.h"
#include "surf/core/progress.h"
#include "surf/io/height_field_file.h"
#include "surf/sem/surface_range.h"
#include "surf/sem/trained_model.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {

/// Predicts an image from heights by a trained model, instead of a simulation.
struct PredictJob {
  std::filesystem::path model;  ///< the model's file
  HeightField field;
  std::filesystem::path input;  ///< file that the heights come from; may be empty
  Edge edge = Edge::mirror;
  bool resample = false;  ///< heights of another pitch are resampled; false: they are refused
  ModelScope wanted;      ///< required scope of the training; empty and 0: any
  int threads = 0;
  /// Output files, formats by extension; none: the image stays in the summary.
  std::vector<std::filesystem::path> outputs;
  std::string png_channel;        ///< channel shown in a PNG; empty: the first
  io::HeightReadOptions reading;  ///< how `input` was read, for the record
};
/// The parameters prediction.model, prediction.edge and so on; not the heights.
void describe(ParameterVisitor& visit, PredictJob& job);

struct PredictSummary {
  TrainedModel model;
  Image image;         ///< the image as written
  SurfaceRange range;  ///< range of the heights at the model's pixel size
  double seconds = 0;  ///< time of the prediction alone
  std::vector<std::string> warnings;
};

/// The heights, resampled to the model's pixel size if the job asks for it; else unchanged.
HeightField heights_for(const PredictJob& job, const ModelScope& scope);

/// Checks model and outputs, predicts and writes. The image has the model's channels in counts per
/// primary and is placed as the heights are. Its metadata state the model and the model's hash.
/// Warns if the surface is steeper than any training surface. Throws UsageError if the model was
/// trained for another scope than `wanted`, InvalidInput, FileError, and Interrupted before
/// anything is written.
PredictSummary run(const PredictJob& job, const Reporter& reporter = {});

/// Warnings about a prediction of these heights: the heights are steeper than any that the model
/// was trained on.
std::vector<std::string> prediction_warnings(const TrainedModel& model, const HeightField& field);

/// What a scene file says of the specimen and the beam. Throws UsageError where the specimen is
/// more than a height field, or the beam is tilted; FileError.
void take_scene(const std::filesystem::path& scene, PredictJob& job);

}  // namespace surf::workflow
