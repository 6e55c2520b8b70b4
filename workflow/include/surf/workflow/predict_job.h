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

/// An image from heights and a model, in place of a simulation.
struct PredictJob {
  std::filesystem::path model;  ///< its file
  HeightField field;
  std::filesystem::path input;  ///< the file that the heights are from; may be empty
  Edge edge = Edge::mirror;
  bool resample = false;  ///< heights of another pitch are resampled, not refused
  ModelScope wanted;      ///< what it must have been trained for; empty and 0: whatever
  int threads = 0;
  std::vector<std::filesystem::path>
      outputs;                    ///< formats by extension; none: the image stays in the summary
  std::string png_channel;        ///< for PNG; empty: the first
  io::HeightReadOptions reading;  ///< how `input` was read: of the record
};
/// prediction.model, prediction.edge and so on; not the heights.
void describe(ParameterVisitor& visit, PredictJob& job);

struct PredictSummary {
  TrainedModel model;
  Image image;         ///< as it was written
  SurfaceRange range;  ///< of the heights, at the model's pixel
  double seconds = 0;  ///< of the prediction alone
  std::vector<std::string> warnings;
};

/// Heights at the pixel of the model, where the job asks for resampling; else as they are.
HeightField heights_for(const PredictJob& job, const ModelScope& scope);

/// Checks model and outputs, predicts and writes. The image has a channel for each of the model's,
/// in counts per primary, placed as the heights are, and says which model of which hash made it.
/// Warns where the surface is steeper than any that the model has learnt from. Throws UsageError
/// where the model was trained for anything else than what is wanted, InvalidInput, FileError, and
/// Interrupted before anything is written.
PredictSummary run(const PredictJob& job, const Reporter& reporter = {});

/// What should be known of a prediction of these heights: whether they are steeper than any that
/// the model has learnt from.
std::vector<std::string> prediction_warnings(const TrainedModel& model, const HeightField& field);

}  // namespace surf::workflow
