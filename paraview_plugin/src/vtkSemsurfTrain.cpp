// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfTrain.h"

#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkTable.h>

#include <memory>
#include <utility>

#include "attempt.h"
#include "checks.h"
#include "convert/image.h"
#include "labels.h"
#include "pipeline.h"
#include "property_values.h"
#include "surf/core/error.h"
#include "surf/io/sim/materials.h"
#include "training.h"
#include "upstream.h"

vtkStandardNewMacro(vtkSemsurfTrain);

using namespace surf;
using pv::need_within;

namespace {

void need(bool good, const char* property, const std::string& reason, const char* remedy) {
  if (!good) throw UsageError(property, reason, remedy);
}

}  // namespace

vtkSemsurfTrain::vtkSemsurfTrain() : Values(std::make_unique<pv::PropertyValues>()) {
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
}
vtkSemsurfTrain::~vtkSemsurfTrain() = default;

void vtkSemsurfTrain::SetParameter(const char* name, double value) {
  if (this->Values->set(name, value)) this->Modified();
}
void vtkSemsurfTrain::SetParameter(const char* name, const char* text) {
  if (this->Values->set(name, text)) this->Modified();
}

int vtkSemsurfTrain::FillInputPortInformation(int, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  info->Set(vtkAlgorithm::INPUT_IS_REPEATABLE(), 1);
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

int vtkSemsurfTrain::RequestInformation(vtkInformation*, vtkInformationVector**,
                                        vtkInformationVector* outputs) {
  for (int port = 0; port < 2; ++port) pv::announce_pieces(outputs->GetInformationObject(port));
  return 1;
}

int vtkSemsurfTrain::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs,
                                         vtkInformationVector*) {
  pv::request_whole(inputs, 2);
  return 1;
}

void vtkSemsurfTrain::AddInputs(vtkInformationVector** inputs, workflow::TrainJob& job) {
  const int surfaces = inputs[0]->GetNumberOfInformationObjects(),
            images = inputs[1]->GetNumberOfInformationObjects();
  need(images == 0 || images == surfaces, "Images",
       fmt::format("there are {} of {} surfaces", images, surfaces),
       "Give one for each, in the same order, or none");
  need(this->Signal.empty() || images > 0, "Signal", "there are no Images that it could be of",
       "Leave it empty, or give one for each surface");
  job.signal = this->Signal;
  for (int i = 0; i < surfaces; ++i) {
    workflow::TrainingInput input;
    input.name = fmt::format("surface-{}", i + 1);
    vtkImageData* const heights = pv::image_input(inputs, 0, "Input", i);
    input.field =
        pv::to_height_field(heights, pv::chosen_array(this, 0, heights), input.name.c_str());
    if (images > 0)
      input.pixels =
          std::make_shared<Image>(pv::to_image(pv::image_input(inputs, 1, "Images", i), "Images"));
    job.inputs.push_back(std::move(input));
  }
  if (surfaces == 0 || job.pixel_nm != 0) return;
  const HeightField& first = job.inputs.front().field;
  need(first.pitch_x_nm == first.pitch_y_nm, "`training.pixel_size`",
       "the samples of the first surface are not square",
       "Say how large the model's pixels are, as 3");
  job.pixel_nm = first.pitch_x_nm;
}

workflow::TrainJob vtkSemsurfTrain::Job(vtkInformationVector** inputs) {
  need_within(this->Budget, 0, 1, "Budget");
  pv::PropertyValues values = *this->Values;
  values.forget(this->Budget == 0 ? "simulation.accuracy" : "simulation.electrons");
  workflow::TrainJob job;
  values.apply(job);
  need(!job.output.empty(), "`output`", "no file is named for the model",
       "Name one that ends in .json");
  need(job.output.extension() == ".json", "`output`",
       fmt::format("{} does not end in .json", job.output.string()), "Name one that does");
  io::MaterialChoice material;
  values.apply(material);
  std::vector<std::string> notes;
  job.material = io::find_material(material, notes);
  job.material_files.assign(material.files.begin(), material.files.end());
  this->AddInputs(inputs, job);
  need(job.pixel_nm > 0, "`training.pixel_size`",
       "it is 0, and there is no surface to take it from", "Give 3 where in doubt");
  check_parameters(job);
  return job;
}

int vtkSemsurfTrain::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                 vtkInformationVector* outputs) {
  // One rank writes the file and the images.
  if (!pv::is_first_piece(outputs->GetInformationObject(0))) return 1;
  return pv::attempt(this, [&] {
    pv::with_labels(
        [&] {
          pv::refuse_overlaps(this, {{"Model File", this->Values->text("output"), {}}},
                              {{"Material File", this->Values->text("specimen.materials"), {}}});
          const workflow::TrainJob job = this->Job(inputs);
          std::vector<std::string> notes;
          workflow::TrainSummary summary;
          pv::work(this, [&](const Watch& watch) { summary = pv::train(job, watch, notes); });
          for (const std::string& warning : summary.model.record.warnings) pv::warn(this, warning);
          vtkNew<vtkTable> errors, model;
          pv::fill_errors(errors, summary.model.record);
          pv::fill_model(model, job, summary, notes);
          pv::give(outputs->GetInformationObject(0), errors);
          pv::give(outputs->GetInformationObject(1), model);
        },
        {{"pixel size", "Pixel Size"}, {"`specimen.material`", "Material"}});
  });
}
