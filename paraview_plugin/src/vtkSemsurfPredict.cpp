// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfPredict.h"

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <utility>

#include "attempt.h"
#include "labels.h"
#include "pipeline.h"
#include "property_values.h"
#include "reports.h"
#include "surf/core/error.h"
#include "surf/io/model/model_file.h"
#include "surf/workflow/predict_job.h"

vtkStandardNewMacro(vtkSemsurfPredict);

using namespace surf;

namespace {

workflow::PredictJob job_of(const pv::PropertyValues& values) {
  workflow::PredictJob job;
  values.apply(job);
  if (job.model.empty())
    throw UsageError("`prediction.model`", "no model is named",
                     "Name one that 'semsurf train' wrote, as samples/si-1keV-3nm.json");
  return job;
}

const pv::Labels labels{{"HEIGHTS", "Input"}};

}  // namespace

/// The image has the model's pixels: as many as resampling gives.
int vtkSemsurfPredict::RequestInformation(vtkInformation*, vtkInformationVector** inputs,
                                          vtkInformationVector* outputs) {
  return pv::attempt_information(this, outputs, [&] {
    pv::with_labels(
        [&] {
          vtkInformation* const input = inputs[0]->GetInformationObject(0);
          int extent[6] = {0, -1, 0, -1, 0, -1};
          double spacing[3] = {1, 1, 1}, origin[3] = {0, 0, 0};
          input->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent);
          if (input->Has(vtkDataObject::SPACING())) input->Get(vtkDataObject::SPACING(), spacing);
          if (input->Has(vtkDataObject::ORIGIN())) input->Get(vtkDataObject::ORIGIN(), origin);
          workflow::PredictJob job = job_of(*this->Values);
          HeightField& like = job.field;
          like.z_nm = Grid<double>(extent[1] - extent[0] + 1, extent[3] - extent[2] + 1);
          like.pitch_x_nm = spacing[0], like.pitch_y_nm = spacing[1];
          like.origin_x_nm = origin[0] + extent[0] * spacing[0],
          like.origin_y_nm = origin[1] + extent[2] * spacing[1];
          const ModelScope scope = io::read_model(job.model).scope;
          const HeightField at_pixel = workflow::heights_for(job, scope);
          check_field(scope, at_pixel, "HEIGHTS");
          pv::announce(outputs->GetInformationObject(0), pv::frame_of(at_pixel.z_nm, at_pixel));
        },
        labels);
  });
}

int vtkSemsurfPredict::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                   vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    pv::with_labels(
        [&] {
          workflow::PredictJob job = job_of(*this->Values);
          std::string name;
          job.field = this->Heights(inputs, name);
          std::vector<std::string> warnings;
          workflow::PredictSummary summary;
          pv::work(this, [&](const Watch& watch) {
            summary = workflow::run(job, pv::hear(watch, warnings));
          });
          pv::warn(this, warnings);
          pv::give(outputs->GetInformationObject(0), pv::to_vtk(std::move(summary.image)));
        },
        labels);
  });
}
