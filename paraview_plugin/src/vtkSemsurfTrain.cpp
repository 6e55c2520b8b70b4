// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfTrain.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkTable.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <utility>

#include "attempt.h"
#include "checks.h"
#include "convert/image.h"
#include "labels.h"
#include "pipeline.h"
#include "surf/core/error.h"
#include "surf/io/sim/materials.h"
#include "training.h"
#include "upstream.h"

vtkStandardNewMacro(vtkSemsurfTrain);

using namespace surf;
using pv::need_within;

namespace {

// In the order of the XML's entries.
constexpr const char* kinds[] = {"facet-network", "filter-bank", "slope-table", "slope-table-two-planes",
                                 "stopping-points", "diffusion-matrix", "secant", "ikeuchi-exponential",
                                 "ikeuchi-secant", "ikeuchi-mixed"};

void need(bool good, const char* property, const std::string& reason, const char* remedy) {
  if (!good) throw UsageError(property, reason, remedy);
}

std::vector<FacetScale> scales_of(const std::vector<int>& sizes) {
  const std::vector<FacetScale> all = thesis_scales();
  std::vector<FacetScale> scales;
  for (const int size : sizes) {
    const auto known = std::ranges::find(all, size, &FacetScale::size);
    if (known == all.end()) {
      std::vector<int> known_sizes;
      std::ranges::transform(all, std::back_inserter(known_sizes), &FacetScale::size);
      throw UsageError("Scales", fmt::format("there is no neighbourhood of {} samples", size),
                       fmt::format("Choose among {}", fmt::join(known_sizes, ", ")));
    }
    scales.push_back(*known);
  }
  return scales;
}

}  // namespace

vtkSemsurfTrain::vtkSemsurfTrain() {
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
}

void vtkSemsurfTrain::AddScale(int samples) {
  this->Scales.push_back(samples);
  this->Modified();
}

void vtkSemsurfTrain::RemoveAllScales() {
  this->Scales.clear();
  this->Modified();
}

void vtkSemsurfTrain::AddHidden(int units) {
  this->Hidden.push_back(units);
  this->Modified();
}

void vtkSemsurfTrain::RemoveAllHidden() {
  this->Hidden.clear();
  this->Modified();
}

int vtkSemsurfTrain::FillInputPortInformation(int, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  info->Set(vtkAlgorithm::INPUT_IS_REPEATABLE(), 1);
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

int vtkSemsurfTrain::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) {
  for (int port = 0; port < 2; ++port) pv::announce_pieces(outputs->GetInformationObject(port));
  return 1;
}

int vtkSemsurfTrain::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector*) {
  pv::request_whole(inputs, 2);
  return 1;
}

void vtkSemsurfTrain::AddModel(workflow::TrainJob& job) const {
  workflow::LearnOptions& learn = job.learn;
  need_within(this->Model, 0, static_cast<int>(std::size(kinds)) - 1, "Model");
  learn.kind = kinds[this->Model];
  learn.scales = scales_of(this->Scales);
  learn.multi_resolution = this->MultiResolution;
  if (this->CutOff >= 0) learn.least_eigenvalue = this->CutOff;
  // One 0 is a network without hidden layers.
  if (!this->Hidden.empty()) learn.hidden = this->Hidden == std::vector{0} ? std::vector<int>() : this->Hidden;
  for (const auto& [value, label] : {std::pair{this->Decay, "Decay"}, {this->Tolerance, "Tolerance"}, {this->CutOff, "Cut Off"}})
    pv::need_number(value, label);   // below 0 they are not given
  need_within(this->Iterations, 0, std::numeric_limits<int>::max(), "Iterations");
  need_within(this->TableElectrons, 0, std::numeric_limits<int>::max(), "Table Electrons");
  if (this->Iterations > 0) learn.iterations = this->Iterations;
  if (this->Decay >= 0) learn.decay = this->Decay;
  if (this->Tolerance >= 0) learn.model_error = this->Tolerance;
  if (this->TableElectrons > 0) learn.table_electrons = this->TableElectrons;
}

void vtkSemsurfTrain::AddInputs(vtkInformationVector** inputs, workflow::TrainJob& job) {
  const int surfaces = inputs[0]->GetNumberOfInformationObjects(), images = inputs[1]->GetNumberOfInformationObjects();
  need(images == 0 || images == surfaces, "Images", fmt::format("there are {} of {} surfaces", images, surfaces),
       "Give one for each, in the same order, or none");
  need(this->Signal.empty() || images > 0, "Signal", "there are no Images that it could be of",
       "Leave it empty, or give one for each surface");
  job.signal = this->Signal;
  for (int i = 0; i < surfaces; ++i) {
    workflow::TrainingInput input;
    input.name = fmt::format("surface-{}", i + 1);
    vtkImageData* const heights = pv::image_input(inputs, 0, "Input", i);
    input.field = pv::to_height_field(heights, pv::chosen_array(this, 0, heights), input.name.c_str());
    if (images > 0)
      input.pixels = std::make_shared<Image>(pv::to_image(pv::image_input(inputs, 1, "Images", i), "Images"));
    job.inputs.push_back(std::move(input));
  }
  job.pixel_nm = this->PixelSize;
  if (surfaces == 0 || this->PixelSize != 0) return;
  const HeightField& first = job.inputs.front().field;
  need(first.pitch_x_nm == first.pitch_y_nm, "Pixel Size", "the samples of the first surface are not square",
       "Say how large the model's pixels are, as 3");
  job.pixel_nm = first.pitch_x_nm;
}

workflow::TrainJob vtkSemsurfTrain::Job(vtkInformationVector** inputs) {
  need(!this->ModelFile.empty(), "Model File", "no file is named for the model", "Name one that ends in .json");
  need_within(this->Edge, 0, 2, "Edge");
  need_within(this->Budget, 0, 1, "Budget");
  need(this->Seed >= 0, "Seed", fmt::format("{} is below 0", this->Seed), "Give 1");
  need(this->Electrons >= 1, "Electrons", fmt::format("{} are too few", this->Electrons),
       "Give 1 or more per pixel");
  need(this->Budget == 0 || (this->Accuracy >= 1e-4 && this->Accuracy <= 1), "Accuracy",
       fmt::format("{} is not in 0.0001 to 1", this->Accuracy), "Give 0.03 for 3 %");
  pv::need_length(this->PixelSize, "Pixel Size");
  need_within(this->Surfaces, 0, std::numeric_limits<int>::max(), "Surfaces");
  workflow::TrainJob job;
  job.output = this->ModelFile;
  need(job.output.extension() == ".json", "Model File", fmt::format("{} does not end in .json", this->ModelFile),
       "Name one that does");
  this->AddModel(job);
  if (this->Surfaces > 0) job.surfaces = this->Surfaces;
  job.surface_px = this->SurfaceSize;
  job.held_out = this->HoldOut;
  job.fine = this->Fine;
  job.edge = static_cast<surf::Edge>(this->Edge);
  job.simulation.seed = static_cast<std::uint64_t>(this->Seed);
  job.simulation.budget = mc::ElectronsPerPixel{this->Electrons};
  if (this->Budget == 1) {
    job.simulation.budget = mc::Accuracy{this->Accuracy};
    job.simulation.method = mc::Method::replay;
  }
  io::MaterialLibrary materials;
  std::vector<std::string> notes;
  if (!this->MaterialFile.empty()) materials.read(this->MaterialFile, notes);
  job.material = materials.find(this->Material, "Material");
  if (!this->MaterialFile.empty()) job.material_files = {this->MaterialFile};
  job.energy_ev = this->Energy;
  job.spot_nm = this->Spot;
  if (!this->Physics.empty()) mc::parse_physics(this->Physics, job.physics);
  this->AddInputs(inputs, job);
  need(job.pixel_nm > 0, "Pixel Size", "it is 0, and there is no surface to take it from", "Give 3 where in doubt");
  check_parameters(job);
  return job;
}

int vtkSemsurfTrain::RequestData(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) {
  // One rank writes the file and the images.
  if (!pv::is_first_piece(outputs->GetInformationObject(0))) return 1;
  return pv::attempt(this, [&] {
    pv::with_labels([&] {
      pv::refuse_overlaps(this, {{"Model File", this->ModelFile, {}}}, {{"Material File", this->MaterialFile, {}}});
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
    }, {{"pixel size", "Pixel Size"}});
  });
}
