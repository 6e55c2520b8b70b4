// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "surf/core/image.h"
#include "surf/core/parameters.h"
#include "surf/workflow/reporter.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {

/// Makes guided images of an image that `semsurf simulate --channels counts,electrons` wrote. Its
/// channels z_nm, normal and material guide where they are there, and so does any other channel.
struct EstimateJob {
  std::filesystem::path input;      ///< may be empty where `image` is given
  Image image;                      ///< used where `input` is empty
  std::vector<std::string> guides;  ///< more channels that guide
  std::filesystem::path model;      ///< a fast model whose prediction guides; may be empty
  int threads = 0;
  /// Output files, formats by extension; none: the image stays in the summary.
  std::vector<std::filesystem::path> outputs;
  std::string png_channel;  ///< channel shown in a PNG; empty: the first
};
/// The parameters estimate.guides, estimate.model and so on; not the image.
void describe(ParameterVisitor& visit, EstimateJob& job);

struct EstimateSummary {
  /// The image with its channels NAME and NAME.stderr estimated anew, and NAME.radius.
  Image image;
  std::vector<std::string> detectors;
  std::vector<GuidedGain> gains;    ///< per detector
  std::vector<std::string> guides;  ///< names of what guided
};

/// Throws InvalidInput for an image without counts, UsageError, FileError, and Interrupted before
/// anything is written.
EstimateSummary run(const EstimateJob& job, const Reporter& reporter = {});

}  // namespace surf::workflow
