// SPDX-License-Identifier: GPL-3.0-or-later
// Gains and offset of a microscope's image.
#include <fmt/format.h>

#include "scan_findings.h"
#include "sem_inputs.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/model/calibration_file.h"
#include "surf/io/scan_parameters.h"
#include "surf/workflow/calibrate_job.h"
#include "surf/workflow/step_record.h"

namespace surf::python {
namespace {

py::object found_of(const Calibration& c) {
  py::dict d, gains;
  for (std::size_t i = 0; i < c.channels.size(); ++i)
    gains[py::str(c.channels[i])] = measured(c.gains[i], c.gain_stderr(i));
  d["gains"] = findings(gains);
  d["offset"] = measured(c.offset, c.offset_stderr());
  d["outcome"] = io::name(c.outcome);
  d["trusted"] = c.outcome == CalibrationOutcome::trusted;
  d["condition_number"] = c.condition_number;
  d["residual_rms"] = c.residual_rms;
  d["explained"] = c.explained;
  d["residual_correlation"] = c.residual_correlation;
  d["pixels"] = c.pixels;
  d["saturated"] = c.saturated;
  return findings(d);
}

py::object calibrate(const Call& call) {
  const auto parameters = call.told<workflow::CalibrateParameters>();
  workflow::check(parameters);
  const std::filesystem::path output = call.has("output") ? path_of(call["output"]) : std::string();
  if (!output.empty()) io::check_writable(output);
  const workflow::SemInput sem = sem_of(call, call["image"], "image");
  const Picture simulated = picture_of(call["simulated"], "simulated");
  std::vector<std::filesystem::path> inputs;
  if (!sem.file.empty()) inputs.push_back(sem.file);
  if (!simulated.file.empty()) inputs.push_back(simulated.file);
  workflow::CalibrateInput input;
  input.image = sem.image;
  input.name = sem.file.empty() ? "image" : sem.file.string();
  input.simulated = simulated.image;
  input.simulated_name = simulated.file.empty() ? "simulated" : simulated.file.string();
  HeightField place;
  place.z_nm = input.image.values;
  place.placement() = input.image.placement();
  place.valid = input.image.valid;
  if (const Mask use = masks_of(call, place, inputs); !use.empty()) {
    if (input.image.valid.empty()) input.image.valid = use;
    else
      for (std::size_t i = 0; i < use.size(); ++i) input.image.valid.data()[i] &= use.data()[i];
  }
  workflow::CalibrateResult result;
  call.work([&](const workflow::Reporter& reporter) {
    result = workflow::calibrate(input, parameters, reporter);
  });
  const auto record =
      workflow::step_record("calibrate", workflow::records_of(parameters, sem.reading), inputs);
  if (!output.empty())
    io::write_calibration(output, {result.calibration, parameters.range_nm.value_or(0), record});
  py::object found = found_of(result.calibration);
  const Placement placement = input.image.placement();
  found["fit"] = picture_of(std::move(result.fit), placement, "calibrated");
  found["residual"] = picture_of(std::move(result.residual), placement, "residual");
  if (!result.gain.empty()) found["gain"] = picture_of(std::move(result.gain), placement, "gain");
  found["record"] = record_of(record);
  return found;
}

}  // namespace

void add_calibrate(py::module_& module) {
  Function f{.name = "calibrate",
             .summary = "Gains and offset that turn simulated images into a real one."};
  f.details =
      "Both images show the same surface, pixel on pixel. The image is the sum of gain times\n"
      "channel, an offset and a residual, fitted by least squares.";
  f.arguments = {
      {"image", sem_type, "The microscope's image.", true, false},
      {"simulated", "PathLike | Image",
       "What `simulate` or `predict` makes of the same surface: channels in counts per primary.",
       true, false},
      use_argument,
      exclude_argument,
      {"output", "PathLike", "A file for `reconstruct` to write: JSON."}};
  f.takes<workflow::CalibrateParameters>().takes<io::SemReadOptions>();
  f.result_type = "Findings";
  f.result =
      "`gains` by channel and `offset` with their standard errors, whether they are `trusted`, and "
      "the images `fit` and `residual`.";
  define(module, f, calibrate);
}

}  // namespace surf::python
