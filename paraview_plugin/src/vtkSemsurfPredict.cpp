// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfPredict.h"

#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <utility>

#include "attempt.h"
#include "pipeline.h"
#include "surf/afm/resample.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/model_file.h"
#include "surf/sem/trained_model.h"
#include "surf/workflow/predict_job.h"
#include "surf/workflow/version.h"

vtkStandardNewMacro(vtkSemsurfPredict);

using namespace surf;

namespace {

TrainedModel read(const std::string& file) {
  if (file.empty())
    throw UsageError("Model File", "no model is named", "Name one that 'semsurf train' wrote, as samples/si-1keV-3nm.json");
  return io::read_model(file);
}

}  // namespace

HeightField vtkSemsurfPredict::AtPixel(const HeightField& field, double pixel_nm) const {
  const bool other = pixel_nm > 0 && (field.pitch_x_nm != pixel_nm || field.pitch_y_nm != pixel_nm);
  return this->Resample && other ? resampled(field, pixel_nm) : field;
}

/// The image has the model's pixels: as many as resampling gives.
int vtkSemsurfPredict::RequestInformation(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) {
  return pv::attempt_information(this, outputs, [&] {
    vtkInformation* const input = inputs[0]->GetInformationObject(0);
    int extent[6] = {0, -1, 0, -1, 0, -1};
    double spacing[3] = {1, 1, 1}, origin[3] = {0, 0, 0};
    input->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent);
    if (input->Has(vtkDataObject::SPACING())) input->Get(vtkDataObject::SPACING(), spacing);
    if (input->Has(vtkDataObject::ORIGIN())) input->Get(vtkDataObject::ORIGIN(), origin);
    HeightField like;
    like.z_nm = Grid<double>(extent[1] - extent[0] + 1, extent[3] - extent[2] + 1);
    like.pitch_x_nm = spacing[0], like.pitch_y_nm = spacing[1];
    like.origin_x_nm = origin[0] + extent[0] * spacing[0], like.origin_y_nm = origin[1] + extent[2] * spacing[1];
    const ModelScope scope = read(this->ModelFile).scope;
    like = this->AtPixel(like, scope.pixel_nm);
    check_field(scope, like, "Input");
    pv::announce(outputs->GetInformationObject(0), pv::frame_of(like.z_nm, like));
  });
}

int vtkSemsurfPredict::RequestData(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    const TrainedModel trained = read(this->ModelFile);
    if (this->Edge < 0 || this->Edge > 2)
      throw UsageError("Edge", fmt::format("there is no edge {}", this->Edge), "Choose 0 to 2");
    std::string name;
    const HeightField field = this->AtPixel(this->Heights(inputs, name), trained.scope.pixel_nm);
    check_field(trained.scope, field, "Input");
    const auto model = make_model(trained);
    ModelImages predicted;
    pv::work(this, [&](const Watch& watch) {
      predicted = model->predict(field, {.edge = static_cast<surf::Edge>(this->Edge), .watch = watch});
    });
    Image image;
    image.pitch_x_nm = field.pitch_x_nm, image.pitch_y_nm = field.pitch_y_nm;
    image.origin_x_nm = field.origin_x_nm, image.origin_y_nm = field.origin_y_nm;
    for (std::size_t c = 0; c < predicted.size(); ++c) {
      Channel channel{model->channels().at(c), "1", Grid<float>(field.z_nm.width(), field.z_nm.height())};
      std::ranges::transform(predicted[c].data(), channel.values.data().begin(), [](double v) { return static_cast<float>(v); });
      image.channels.push_back(std::move(channel));
    }
    image.metadata = {{"semsurf.version", workflow::version()}, {"command", "predict"}, {"model.kind", io::kind_of(trained)}};
    if (!trained.scope.material.empty()) image.metadata["material.1.name"] = trained.scope.material;
    if (trained.scope.energy_ev > 0) image.metadata["beam.energy_ev"] = format_exact(trained.scope.energy_ev);
    for (const std::string& warning : workflow::prediction_warnings(trained, field)) pv::warn(this, warning);
    pv::give(outputs->GetInformationObject(0), pv::to_vtk(std::move(image)));
  });
}
